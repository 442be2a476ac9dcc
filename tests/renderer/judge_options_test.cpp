// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The command line of the judge.
#include <sstream>

#include <gtest/gtest.h>

#include "errors.h"
#include "image_metadata.h"
#include "judge_setup.h"
#include "options.h"

namespace nightcity {
namespace {

Options parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), {"nightcity-render", "s", "-o", "a.exr"});
    std::ostringstream out;
    return *parseOptions(int(arguments.size()), arguments.data(), out);
}

std::string refusal(const std::vector<const char*>& arguments) {
    try {
        parse(arguments);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "(accepted)";
}

TEST(JudgeOptions, ReferenceIsExactUnlessStepsAreGiven) {
    EXPECT_EQ(parse({"--method", "reference"}).settings.tolerance, 0.01);
    EXPECT_EQ(parse({"--method", "reference", "--tolerance", "0.001"}).settings.tolerance, 0.001);
    EXPECT_FALSE(parse({"--method", "reference", "--subdivisions", "9"}).settings.tolerance);
    EXPECT_FALSE(parse({"--method", "march"}).settings.tolerance);
}

TEST(JudgeOptions, GaussTakesAToleranceAndNoSteps) {
    EXPECT_EQ(parse({"--method", "gauss"}).settings.tolerance, 0.01);
    EXPECT_EQ(parse({"--method", "gauss", "--model", "single", "--tolerance", "1e-4"}).settings.tolerance,
              1e-4);
    for (const char* tolerance : {"9e-5", "0.2", "nan"}) {
        EXPECT_NE(refusal({"--method", "gauss", "--tolerance", tolerance}).find("1e-4 to 0.1"),
                  std::string::npos) << tolerance;
    }
    for (const std::vector<const char*>& given :
         {std::vector<const char*>{"--subdivisions", "5"}, {"--march-order", "steps"},
          {"--samples", "4"}, {"--scattering", "multiple"}}) {
        std::vector<const char*> all{"--method", "gauss"};
        all.insert(all.end(), given.begin(), given.end());
        EXPECT_NE(refusal(all).find(given[0]), std::string::npos) << refusal(all);
    }
}

TEST(JudgeOptions, SwitchesComeAfterTheModel) {
    const Model model = parse({"--method", "reference", "--emitter", "lambertian", "--surfaces", "lit",
                               "--model", "single"}).settings.model;
    EXPECT_EQ(model.lights, Lights::all);
    EXPECT_EQ(model.visibility, Visibility::full);
    EXPECT_EQ(model.emitter, Emitter::lambertian);
    EXPECT_EQ(model.surfaces, Surfaces::lit);
}

TEST(JudgeOptions, WhatTheMarchDoesNotKnowIsRefused) {
    const std::vector<const char*> switches[] = {
        {"--lights", "all"}, {"--visibility", "full"}, {"--emitter", "pane"}, {"--surfaces", "lit"}};
    for (std::vector<const char*> given : switches) {
        std::vector<const char*> marched = given;
        marched.insert(marched.end(), {"--method", "march"});
        EXPECT_NE(refusal(marched).find(given[0]), std::string::npos) << refusal(marched);
        given.insert(given.end(), {"--method", "reference", "--subdivisions", "5"});
        EXPECT_NE(refusal(given).find("march knows only"), std::string::npos) << refusal(given);
    }
    for (const char* tolerance : {"0", "-1", "nan", "2", "1e-9"}) {
        EXPECT_NE(refusal({"--method", "reference", "--tolerance", tolerance}).find("--tolerance"),
                  std::string::npos) << tolerance;
    }
    EXPECT_NE(refusal({"--method", "march", "--tolerance", "0.1"}).find("--tolerance"),
              std::string::npos);
}

TEST(JudgeOptions, ReachIsForMethodsThatKnowIt) {
    for (const char* method : {"gauss", "path", "reference"}) {
        EXPECT_EQ(parse({"--method", method, "--lights", "all", "--reach", "30"}).settings.reach, 30);
        EXPECT_FALSE(parse({"--method", method, "--lights", "all"}).settings.reach);
        const std::string listed =
            refusal({"--method", method, "--model", "paper", "--reach", "30"});
        EXPECT_NE(listed.find("--reach needs --lights all"), std::string::npos) << listed;
        for (const char* reach : {"0", "-1", "nan", "inf", "2e6"}) {
            const std::string said =
                refusal({"--method", method, "--lights", "all", "--reach", reach});
            EXPECT_NE(said.find("--reach must lie"), std::string::npos) << said;
        }
    }
    for (const std::vector<const char*>& method :
         {std::vector<const char*>{"--method", "march"}, {"--method", "field", "--model", "single"},
          {"--method", "reference", "--subdivisions", "5"}}) {
        std::vector<const char*> all = method;
        all.insert(all.end(), {"--reach", "30"});
        EXPECT_NE(refusal(all).find("--reach is for"), std::string::npos) << refusal(all);
    }
}
TEST(JudgeOptions, MetadataNamesToleranceOrSteps) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product;
    product.camera = "street";
    const auto names = [&](const RenderSettings& settings) {
        std::string all;
        for (const auto& [name, value] :
             describeImage(scene, product, settings, {}, ImageFormat::exr).entries) {
            all += name + "=" + value + " ";
        }
        return all;
    };
    RenderSettings settings = exactModel(Emitter::pane);
    settings.method = Method::reference;
    EXPECT_NE(names(settings).find("subdivisions=25 "), std::string::npos);
    settings.tolerance = 0.001;
    EXPECT_NE(names(settings).find("tolerance=0.001 "), std::string::npos);
    EXPECT_EQ(names(settings).find("subdivisions"), std::string::npos);
    EXPECT_NE(names(settings).find("emitter=pane "), std::string::npos);
    EXPECT_EQ(names(settings).find("reach"), std::string::npos);
    settings.reach = 30;
    EXPECT_NE(names(settings).find("reach=30 "), std::string::npos);
}

}  // namespace
}  // namespace nightcity
