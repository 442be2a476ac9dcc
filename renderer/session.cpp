// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "session.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>

#include "aovs.h"
#include "errors.h"
#include "frame_names.h"
#include "frame_source.h"
#include "image_metadata.h"
#include "output/channels.h"
#include "output/image_file.h"
#include "output/statistics.h"
#include "progress.h"
#include "reference/reference_renderer.h"
#include "scene/scene_file.h"
#include "stop_signal.h"

namespace nightcity {

namespace {

constexpr float kRepeatStep = 0.1f;  // m along the camera's right vector (design section 6)

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string chooseCamera(const FlatScene& scene, const Options& options) {
    std::string name = options.camera.value_or("");
    if (name.empty()) {  // a farm's parameter that nobody set
        name = scene.defaults.camera;
    }
    if (name.empty() && !scene.cameras.empty()) {
        name = scene.cameras.front().name;
    }
    return scene.camera(name).name;  // or an error that lists the names
}

glm::uvec2 chooseSize(const FlatScene& scene, const Options& options, const std::string& camera,
                      int frame) {
    if (options.size) {
        return *options.size;
    }
    const RenderDefaults& defaults = scene.defaults;
    const double aspect = scene.camera(camera).at(frame).aspect;
    const auto side = [](double pixels) { return glm::uint(std::clamp(pixels + 0.5, 1.0, 65536.0)); };
    if (defaults.width > 0 && defaults.height > 0) {
        return {defaults.width, defaults.height};
    }
    if (defaults.width > 0) {
        return {defaults.width, side(defaults.width / aspect)};
    }
    if (defaults.height > 0) {
        return {side(defaults.height * aspect), defaults.height};
    }
    return {1920, 1061};
}

class Session {
public:
    explicit Session(const Options& options)
        : options_(options),
          format_(imageFormat(options.output)),
          progress_(options.progress, std::cout),
          started_(Clock::now()),
          scene_(loadScene(options.scene)) {
        report_.loadMilliseconds = millisecondsSince(started_);
    }

    void run() {
        prepare();
        const std::vector<int> frames =
            options_.frames.value_or(std::vector<int>{scene_.frames.first});
        if (options_.listMissing) {
            listMissing(frames);
            return;
        }
        for (std::size_t i = 0; i < frames.size(); ++i) {
            stopIfAsked();
            progress_.frames(i, frames.size());
            renderFrame(frames[i]);
        }
        progress_.frames(frames.size(), frames.size());
        if (!options_.stats.empty() && !report_.frames.empty()) {
            completeReport();
            const FinishFirst whole;
            writeStatistics(options_.stats, report_);
            progress_.line("wrote " + options_.stats.string());
        }
    }

private:
    // Everything that can be wrong is asked before the first frame.
    void prepare() {
        const int first = options_.frames ? options_.frames->front() : scene_.frames.first;
        product_.camera = chooseCamera(scene_, options_);
        const glm::uvec2 size = chooseSize(scene_, options_, product_.camera, first);
        product_.width = size.x;
        product_.height = size.y;
        product_.frame = first;
        if (options_.tile) {
            product_.tile = tileRows(*options_.tile, size.y);
            image_.rows = {product_.tile->first, size.y};
        }
        if (options_.pixelFile) {
            product_.pixels = readPixels(*options_.pixelFile, size);
        } else if (options_.pixelCount) {
            product_.pixels =
                selectPixels(scene_, product_, *options_.pixelCount, options_.settings.seed);
            if (product_.pixels.empty()) {
                throw UsageError("--pixels: no pixel of camera " + product_.camera +
                                 " sees a medium; choose another camera");
            }
            if (product_.pixels.size() < *options_.pixelCount) {
                note("only " + std::to_string(product_.pixels.size()) + " pixels of camera " +
                     product_.camera + " see a medium; all of them are rendered");
            }
        }
        image_.pixels = product_.pixels;
        image_.exposure = options_.exposure;
        image_.choice = options_.choice;
        image_.aovs = chooseAovs();
        if (options_.settings.method == Method::path && !options_.aovs) {
            image_.aovs = image_.aovs.empty() ? commonAovs() : image_.aovs;
            if (std::find(image_.aovs.begin(), image_.aovs.end(), kErrorAov) == image_.aovs.end()) {
                image_.aovs.emplace_back(kErrorAov);
            }
        }
        const bool display = format_ == ImageFormat::png || format_ == ImageFormat::jpeg;
        product_.aovs = display ? kAovBeauty : aovBits(image_.aovs);
    }

    std::vector<std::string> chooseAovs() {
        if (options_.aovs) {
            return *options_.aovs;
        }
        if (format_ == ImageFormat::csv) {
            return {};  // all
        }
        std::vector<std::string> known;
        for (const std::string& aov : scene_.defaults.aovs) {
            try {
                selectChannels({&aov, 1});
                known.push_back(aov);
            } catch (const UsageError& error) {
                note(std::string("the stage's render settings: ") + error.what());
            }
        }
        return known;
    }

    // What the image of a frame says of itself.
    ImageMetadata startFrame(int frame) {
        product_.frame = frame;
        product_.cameraOffset = glm::vec3(0);
        return describeImage(scene_, product_, options_.settings, image_, format_, options_.tile);
    }

    std::filesystem::path imageFile(int frame) const {
        const std::filesystem::path file = frameFile(options_.output, frame);
        return options_.tile ? tileFile(file, *options_.tile) : file;
    }

    // The image that makes rendering the frame needless: its own, or of a tile the whole frame.
    std::optional<std::filesystem::path> findImage(int frame, const ImageMetadata& metadata) const {
        const auto& [name, value] = metadata.entries.back();  // the settings' hash
        const std::uint32_t width = product_.width;
        const std::filesystem::path whole = frameFile(options_.output, frame);
        if (isWholeImage(whole, name, value, width, product_.height)) {
            return whole;
        }
        const std::filesystem::path tile = imageFile(frame);
        if (options_.tile &&
            isWholeImage(tile, name, value, width, product_.rows().count, image_.rows)) {
            return tile;
        }
        return std::nullopt;
    }

    void listMissing(const std::vector<int>& frames) {
        std::size_t missing = 0;
        for (const int frame : frames) {
            stopIfAsked();
            if (!findImage(frame, startFrame(frame))) {
                std::cout << "missing " << imageFile(frame).string() << std::endl;
                ++missing;
            }
        }
        if (missing > 0) {
            throw std::runtime_error(std::to_string(missing) + " of " +
                                     std::to_string(frames.size()) +
                                     " images are missing, not whole or of other settings");
        }
    }

    void renderFrame(int frame) {
        const ImageMetadata metadata = startFrame(frame);
        if (options_.skipExisting) {
            if (const auto found = findImage(frame, metadata)) {
                progress_.line("kept " + found->string());
                return;
            }
        }
        const std::filesystem::path file = imageFile(frame);
        const Clock::time_point start = Clock::now();
        const Frame pixels = renderOnce("frame " + std::to_string(frame));
        {
            const FinishFirst whole;
            writeImage(file, pixels, metadata, image_);
        }
        char seconds[32];
        std::snprintf(seconds, sizeof seconds, " (%.2f s)", millisecondsSince(start) / 1000);
        progress_.line("wrote " + file.string() + seconds);
        settings_ = metadata.entries;
        const glm::vec3 right = scene_.camera(product_.camera).at(frame).right;
        for (std::uint32_t repeat = 1; repeat < options_.repeat; ++repeat) {
            product_.cameraOffset = float(repeat) * kRepeatStep * right;
            renderOnce("repeat " + std::to_string(repeat + 1));
        }
    }

    Frame renderOnce(const std::string& name) {
        const bool first = !source_;
        if (first) {
            source_ = makeFrameSource(scene_, options_);
        }
        const std::clock_t before = std::clock();
        Frame frame = source_->render(product_, [&](double share) {
            progress_.update(name, share);
            stopIfAsked();
        });
        report_.processorMilliseconds.push_back(1e3 * double(std::clock() - before) /
                                                CLOCKS_PER_SEC);
        report_.frames.push_back(source_->statistics());
        const bool updated = !first && product_.frame != renderedFrame_;
        renderedFrame_ = product_.frame;
        if (updated) {
            report_.updateMilliseconds.push_back(source_->statistics().bakeMilliseconds);
        }
        if (first) {
            report_.bakeMilliseconds = source_->statistics().bakeMilliseconds;
            for (const std::string& sentence : source_->notes()) {
                note(sentence);
            }
        }
        return frame;
    }

    void note(const std::string& sentence) {
        report_.notes.push_back(sentence);
        if (options_.progress != ProgressStyle::none) {
            std::cerr << "note: " << sentence << std::endl;
        }
    }

    void completeReport() {
        report_.settings = settings_;
        report_.buildings = scene_.buildings.size();
        report_.windows = scene_.windows.size();
        report_.mediaBoxes = scene_.mediaBoxes.size();
        report_.triangles = scene_.triangles.size() + 12 * scene_.mediaBoxes.size() +
                            2 * scene_.windows.size();
        report_.lightListEntries = scene_.lightList.size();
    }

    const Options& options_;
    ImageFormat format_;
    Progress progress_;
    Clock::time_point started_;
    FlatScene scene_;
    RenderProduct product_;
    ImageOptions image_;
    StatisticsReport report_;
    std::vector<std::pair<std::string, std::string>> settings_;  // of the last image
    std::unique_ptr<FrameSource> source_;
    int renderedFrame_ = 0;  // by source_
};

}  // namespace

void runSession(const Options& options) {
    Session(options).run();
}

}  // namespace nightcity
