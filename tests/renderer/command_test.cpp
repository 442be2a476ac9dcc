// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The program as its user runs it, with the method that needs no device.
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>

#include "scene_builder.h"
#include "temporary_folder.h"

extern char** environ;

namespace nightcity {
namespace {

class Command : public testing::Test {
protected:
    Command() {
        std::filesystem::create_directory(at("city.scene"));
        paperCity(1).write(at("city.scene"));
    }

    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }

    pid_t start(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), NIGHTCITY_RENDER);
        std::vector<char*> pointers;
        for (std::string& argument : arguments) {
            pointers.push_back(argument.data());
        }
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        const std::string out = at("out.txt"), error = at("error.txt");
        posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        posix_spawn_file_actions_addopen(&files, 2, error.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        pid_t child = 0;
        EXPECT_EQ(posix_spawn(&child, NIGHTCITY_RENDER, &files, nullptr, pointers.data(), environ), 0);
        posix_spawn_file_actions_destroy(&files);
        return child;
    }

    int wait(pid_t child) const {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    int run(std::vector<std::string> arguments) const { return wait(start(std::move(arguments))); }

    std::vector<std::string> render(const std::string& output,
                                    const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{at("city.scene"), "--camera", "street", "--size", "32x18",
                                           "--method", "reference", "--subdivisions", "3", "-o",
                                           at(output)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    std::string text(const std::string& name) const {
        std::ifstream in(at(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    TemporaryFolder folder_;
};

TEST_F(Command, RendersAndCounts) {
    ASSERT_EQ(run(render("a.exr", {"--stats", at("s.json"), "--repeat", "3"})), 0) << text("error.txt");
    EXPECT_TRUE(std::filesystem::exists(at("a.exr")));
    const auto stats = nlohmann::json::parse(text("s.json"));
    EXPECT_EQ(stats["counts"]["triangles"], 268);
    EXPECT_EQ(stats["counts"]["buildings"], 1);
    EXPECT_EQ(stats["counts"]["windows"], 80);
    EXPECT_EQ(stats["counts"]["media_boxes"], 8);
    EXPECT_EQ(stats["timing"]["steady_frames"], 2);
    EXPECT_GT(stats["counts"]["light_evaluations"], 0);
    EXPECT_TRUE(text("error.txt").empty()) << text("error.txt");
}

TEST_F(Command, SameBytesTwiceAndWithOrWithoutRepeats) {
    ASSERT_EQ(run(render("a.exr")), 0);
    ASSERT_EQ(run(render("b.exr", {"--repeat", "2", "--quiet"})), 0);
    EXPECT_EQ(text("a.exr"), text("b.exr"));
    EXPECT_TRUE(text("out.txt").empty());
}

TEST_F(Command, PixelTables) {
    ASSERT_EQ(run(render("a.csv", {"--pixels", "20"})), 0) << text("error.txt");
    ASSERT_EQ(run(render("b.csv", {"--pixels", at("a.csv")})), 0) << text("error.txt");
    EXPECT_EQ(text("a.csv"), text("b.csv"));
    EXPECT_EQ(text("a.csv").substr(0, 10), "x,y,R,G,B,");
}

TEST_F(Command, ExistingImagesAreKeptWhileTheyFit) {
    const std::vector<std::string> frames{"--frames", "1-2", "--skip-existing"};
    ASSERT_EQ(run(render("a.##.png", frames)), 0) << text("error.txt");
    EXPECT_TRUE(std::filesystem::exists(at("a.01.png")));
    ASSERT_EQ(run(render("a.##.png", frames)), 0);
    EXPECT_EQ(text("out.txt"), "kept " + at("a.01.png") + "\nkept " + at("a.02.png") + "\n");
    std::ofstream(at("a.02.png"), std::ios::trunc) << "half";
    ASSERT_EQ(run(render("a.##.png", frames)), 0);
    EXPECT_NE(text("out.txt").find("wrote " + at("a.02.png")), std::string::npos);
    ASSERT_EQ(run(render("a.##.png", {"--frames", "1-2", "--skip-existing", "--seed", "5"})), 0);
    EXPECT_NE(text("out.txt").find("wrote " + at("a.01.png")), std::string::npos);
}

TEST_F(Command, MissingImagesAreListedAndNotRendered) {
    ASSERT_EQ(run(render("a.##.png", {"--frames", "1:3:2"})), 2);
    ASSERT_EQ(run(render("a.##.png", {"--frames", "1-3:2"})), 0) << text("error.txt");
    EXPECT_EQ(run(render("a.##.png", {"--frames", "1-4", "--list-missing"})), 1);
    EXPECT_EQ(text("out.txt"), "missing " + at("a.02.png") + "\nmissing " + at("a.04.png") + "\n");
    EXPECT_NE(text("error.txt").find("2 of 4 images"), std::string::npos) << text("error.txt");
    EXPECT_EQ(run(render("a.##.png", {"--frames", "1,3", "--list-missing"})), 0);
    EXPECT_EQ(run(render("a.##.png", {"--frames", "1,3", "--list-missing", "--seed", "5"})), 1);
    EXPECT_FALSE(std::filesystem::exists(at("a.02.png")));
}

TEST_F(Command, TilesHaveNamesOfTheirOwnAndAreKeptWhileTheyFit) {
    const std::vector<std::string> tile{"--tile", "2/3", "--skip-existing"};
    ASSERT_EQ(run(render("a.exr", tile)), 0) << text("error.txt");
    EXPECT_TRUE(std::filesystem::exists(at("a.2of3.exr")));
    EXPECT_FALSE(std::filesystem::exists(at("a.exr")));
    ASSERT_EQ(run(render("a.exr", tile)), 0);
    EXPECT_EQ(text("out.txt"), "kept " + at("a.2of3.exr") + "\n");
    ASSERT_EQ(run(render("a.exr")), 0);
    ASSERT_EQ(run(render("a.exr", {"--tile", "1/3", "--skip-existing"})), 0);
    EXPECT_EQ(text("out.txt"), "kept " + at("a.exr") + "\n");
    EXPECT_EQ(run(render("a.exr", {"--tile", "2/19"})), 2);
    EXPECT_NE(text("error.txt").find("18 rows"), std::string::npos) << text("error.txt");
}

TEST_F(Command, FarmsReadProgress) {
    ASSERT_EQ(run(render("a.#.png", {"--frames", "1-2", "--progress", "farm"})), 0);
    const std::string shown = text("out.txt");
    for (const char* share : {"0", "50", "100"}) {
        const std::string lines =
            "openjd_progress: " + std::string(share) + "\nALF_PROGRESS " + share + "%\n";
        EXPECT_NE(shown.find(lines), std::string::npos) << shown;
    }
}

TEST_F(Command, AnEmptyCameraIsTheStages) {
    const auto frame = [&](const char* file) {
        return std::vector<std::string>{at("city.scene"), "--size", "32x18", "--method", "reference",
                                        "--subdivisions", "3", "-o", at(file)};
    };
    ASSERT_EQ(run(frame("a.exr")), 0) << text("error.txt");
    std::vector<std::string> empty = frame("b.exr");
    empty.insert(empty.end(), {"--camera", ""});
    ASSERT_EQ(run(empty), 0) << text("error.txt");
    EXPECT_EQ(text("a.exr"), text("b.exr"));
}

TEST_F(Command, ExitCodes) {
    EXPECT_EQ(run({"--version"}), 0);
    EXPECT_EQ(run({"--nonsense"}), 2);
    EXPECT_EQ(run(render("a.exr", {"--camera", "roof"})), 2);
    EXPECT_EQ(run({at("none.scene"), "-o", at("a.exr")}), 3);
    EXPECT_NE(text("error.txt").find("error: " + at("none.scene") + "/scene.json"), std::string::npos)
        << text("error.txt");
    EXPECT_FALSE(std::filesystem::exists(at("a.exr")));
}

TEST_F(Command, TermKeepsWhatIsFinishedAndLeavesNoHalf) {
    const pid_t child = start({at("city.scene"), "--camera", "street", "--size", "64x36", "--method",
                               "reference", "--subdivisions", "20", "--frames", "1-100000", "-o",
                               at("a.######.exr")});
    for (int i = 0; i < 600 && !std::filesystem::exists(at("a.000002.exr")); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ::kill(child, SIGTERM);
    EXPECT_EQ(wait(child), 143) << text("error.txt");
    EXPECT_TRUE(std::filesystem::exists(at("a.000002.exr")));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
        EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    }
}

// A dispatch of minutes, in which nobody asks whether to stop.
TEST_F(Command, TermEndsWhatTheDeviceHasBegun) {
    const auto render = [&](const char* steps) {
        return start({at("city.scene"), "--camera", "street", "--size", "64x36", "--method",
                      "march", "--subdivisions", steps, "-o", at("a.exr")});
    };
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(wait(render("1")), 0) << text("error.txt");
    std::filesystem::remove(at("a.exr"));
    const auto quick = std::chrono::steady_clock::now() - start;
    const pid_t child = render("16777216");
    std::this_thread::sleep_for(quick);
    ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0) << text("error.txt");
    const auto asked = std::chrono::steady_clock::now();
    ::kill(child, SIGTERM);
    EXPECT_EQ(wait(child), 143) << text("error.txt");
    EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(5));
    EXPECT_NE(text("error.txt").find("stopped by signal 15"), std::string::npos);
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
        EXPECT_EQ(entry.path().filename().string().find("a.exr"), std::string::npos);
    }
}

}  // namespace
}  // namespace nightcity
