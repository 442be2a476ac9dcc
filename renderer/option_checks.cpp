// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "option_checks.h"

#include <algorithm>
#include <cmath>

#include <unistd.h>

#include "errors.h"
#include "frame_names.h"
#include "output/channels.h"
#include "output/image_file.h"

namespace nightcity {

namespace {

constexpr double kMostReach = 1e6;  // m

void require(bool holds, const std::string& message) {
    if (!holds) {
        throw UsageError(message);
    }
}

void checkWritable(const char* option, const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    require(std::filesystem::is_directory(folder),
            std::string(option) + " " + file.string() + ": there is no folder " + folder.string() +
                "; make it first");
    require(::access(folder.c_str(), W_OK) == 0, std::string(option) + " " + file.string() +
                                                     ": the folder " + folder.string() +
                                                     " cannot be written; choose another");
    require(!std::filesystem::is_directory(file),
            std::string(option) + " " + file.string() + ": is a folder; give a file's name");
}

void checkOutput(const Options& options, const Given& given) {
    require(!options.output.empty(), "-o FILE is missing; give the image to write");
    const ImageFormat format = imageFormat(options.output);
    const bool table = format == ImageFormat::csv;
    const bool display = format == ImageFormat::png || format == ImageFormat::jpeg;
    require(table == given("--pixels"),
            table ? "-o " + options.output.string() + ": a table needs --pixels N or --pixels FILE"
                  : "--pixels writes a table; end -o in .csv");
    require(!display || !given("--aovs"), "--aovs is for .exr and .csv; PNG and JPEG show beauty");
    require(display || !given("--exposure"),
            "--exposure is for .png and .jpg; EXR and CSV keep the radiance");
    require(!table || !(options.skipExisting || options.listMissing),
            "--skip-existing and --list-missing are for images, not for tables");
    require(format == ImageFormat::exr || !options.tile,
            "--tile is for .exr, which says where in the frame a tile lies");
    checkWritable("-o", options.output);
    if (!options.stats.empty()) {
        checkWritable("--stats", options.stats);
    }
}

void checkSequence(const Options& options) {
    const std::size_t frames = options.frames ? options.frames->size() : 1;
    require(frames == 1 || hasFramePlace(options.output),
            "--frames: several frames need a place in -o, like " +
                options.output.stem().string() + ".####" + options.output.extension().string());
    require(frames == 1 || options.repeat == 1, "--repeat times one frame; give one in --frames");
    require(!options.skipExisting || options.repeat == 1,
            "--skip-existing and --repeat exclude each other");
}

// What only the exact integral knows.
void checkMarchedModel(const Model& model) {
    const Model paper;
    const auto same = [](auto value, auto known, const std::string& option, const char* name) {
        require(value == known, option + ": march knows only " + name +
                                    "; --method gauss knows all, and reference without --subdivisions");
    };
    same(model.lights, paper.lights, "--lights", "listed");
    same(model.visibility, paper.visibility, "--visibility", "none");
    same(model.emitter, paper.emitter, "--emitter", "isotropic");
    same(model.surfaces, paper.surfaces, "--surfaces", "dim");
}

bool isAovNamed(const Options& options, std::string_view name) {
    return options.aovs && std::find(options.aovs->begin(), options.aovs->end(), name) !=
                               options.aovs->end();
}

constexpr const char* kPathOptions[] = {"--samples", "--orders", "--g"};

// What only the path tracer knows, and what it does not.
void checkPaths(const Options& options, const Given& given) {
    const RenderSettings& settings = options.settings;
    if (settings.method != Method::path) {
        for (const char* name : kPathOptions) {
            require(!given(name), std::string(name) + " is for --method path");
        }
        require(settings.model.scattering == Scattering::single ||
                    settings.method == Method::field,
                "--scattering multiple is for --method field and path; the others know single");
        require(!isAovNamed(options, kErrorAov),
                "--aovs glowError is for --method path; the others have no noise");
        return;
    }
    for (const char* name :
         {"--subdivisions", "--tolerance", "--march-order", "--light-storage", "--light-cap"}) {
        require(!given(name), std::string(name) + " is not for --method path; it takes --samples");
    }
    const double paths = double(settings.samples) * settings.pixelSamples;
    require(paths >= 2, "--samples 1: an error estimate needs at least 2 paths a pixel");
    require(paths < 4294967296.0, "--samples times --pixel-samples must be below 2^32");
    require(std::abs(settings.anisotropy) <= 0.99f, "--g must lie from -0.99 to 0.99");
    require(settings.model.scattering == Scattering::multiple || !given("--orders") ||
                settings.orders == Orders{1, 1},
            "--orders: single scattering is order 1 only; add --scattering multiple");
}

void checkGauss(const Options& options, const Given& given) {
    for (const char* name : {"--subdivisions", "--march-order"}) {
        require(!given(name), std::string(name) + " is for --method march; gauss takes --tolerance");
    }
    const double tolerance = options.settings.tolerance.value_or(0.01);
    require(tolerance >= 1e-4 && tolerance <= 0.1,
            "--tolerance of --method gauss must lie from 1e-4 to 0.1; --method reference goes "
            "down to 1e-7");
}

void checkField(const Options& options, const Given& given) {
    for (const char* name : {"--subdivisions", "--march-order", "--light-storage", "--light-cap"}) {
        require(!given(name), std::string(name) + " is not for --method field, which takes "
                                                  "--tolerance; add --method march");
    }
    const RenderSettings& settings = options.settings;
    const double tolerance = settings.tolerance.value_or(kFieldTolerance);
    require(tolerance >= 1e-3 && tolerance <= 0.1,
            "--tolerance must lie from 0.001 to 0.1 for --method field; --method reference goes on");
    require(settings.model.lights == Lights::all,
            "--lights listed: --method field knows all lights only, as lists end at the borders of "
            "media boxes and what it bakes does not; take --method gauss or march, or --lights all");
}

void checkReach(const Options& options, const Given& given) {
    const RenderSettings& settings = options.settings;
    if (!settings.reach) {
        return;
    }
    const bool known = settings.method == Method::gauss || settings.method == Method::path ||
                       (settings.method == Method::reference && !given("--subdivisions"));
    require(known, "--reach is for --method gauss, path, and reference without --subdivisions");
    require(std::isfinite(*settings.reach) && *settings.reach > 0 && *settings.reach <= kMostReach,
            "--reach must lie above 0 and at most at 1e6 m");
    require(settings.model.lights == Lights::all,
            "--reach needs --lights all; listed windows reach as far as the lists");
}

void checkMethod(const Options& options, const Given& given) {
    const RenderSettings& settings = options.settings;
    checkReach(options, given);
    checkPaths(options, given);
    for (const std::string_view name : kLedgerAovNames) {
        require(settings.method == Method::field || !isAovNamed(options, name),
                "--aovs " + std::string(name) + " is for --method field; --method path has " +
                    std::string(kErrorAov));
    }
    require(!settings.writeOnly || (!settings.media && settings.model.surfaces == Surfaces::dim &&
                                    settings.method != Method::path),
            "--write-only is for --media off, dim surfaces and any method but path: it is the least "
            "that the surface frame can cost");
    require(settings.method == Method::field || !given("--bricks"),
            "--bricks is for --method field");
    if (settings.method == Method::path) {
        return;
    }
    if (settings.method == Method::gauss) {
        checkGauss(options, given);
        return;
    }
    if (settings.method == Method::field) {
        checkField(options, given);
        return;
    }
    const bool exact = settings.method == Method::reference && !given("--subdivisions");
    require(!given("--tolerance") || exact,
            "--tolerance is for --method gauss, and reference without --subdivisions; the march "
            "takes steps");
    const double tolerance = settings.tolerance.value_or(1);
    require(tolerance >= 1e-7 && tolerance <= 1, "--tolerance must lie from 1e-7 to 1");
    if (!exact) {
        checkMarchedModel(settings.model);
    }
    if (settings.method == Method::march) {
        return;
    }
    for (const char* name : {"--march-order", "--light-storage", "--primary", "--device", "--memory",
                             "--validation"}) {
        require(!given(name), std::string(name) + " is for --method march; the reference runs on the CPU");
    }
}

}  // namespace

bool asksForPaths(const Options& options, const Given& given) {
    return std::ranges::any_of(kPathOptions, given) || isAovNamed(options, kErrorAov);
}

void checkCombinations(const Options& options, const Given& given) {
    if (options.listDevices) {
        return;
    }
    require(!options.scene.empty(), "no scene is given; see nightcity-render --help");
    require(options.pixelCount.value_or(1) > 0, "--pixels 0: give at least 1");
    require(std::isfinite(options.exposure) && std::abs(options.exposure) <= 64,
            "--exposure must lie from -64 to 64");
    if (options.aovs) {
        selectChannels(*options.aovs);
    }
    checkOutput(options, given);
    checkSequence(options);
    checkMethod(options, given);
}

}  // namespace nightcity
