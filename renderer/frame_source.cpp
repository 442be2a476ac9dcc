// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_source.h"

#include <iomanip>
#include <optional>
#include <sstream>

#include "reference/reference_renderer.h"

namespace nightcity {

namespace {

constexpr double kBakeShare = 0.9;  // of a frame that bakes first

class DeviceFrames final : public FrameSource {
public:
    DeviceFrames(const FlatScene& scene, const Options& options)
        : scene_(scene), settings_(options.settings), delegate_(RenderDelegate::create(options.device)) {}

    Frame render(const RenderProduct& product, const ProgressCallback& progress) override {
        double baked = 0;
        if (!syncedFrame_) {
            delegate_->planMemory(scene_, product, settings_);
        }
        if (syncedFrame_ != product.frame) {
            const SceneChanges changes{.geometry = !syncedFrame_, .windowState = true};
            delegate_->sync(scene_, product.camera, product.frame, settings_, changes,
                            [&](double share) {
                                baked = kBakeShare * share;
                                progress(baked);
                            });
            syncedFrame_ = product.frame;
        }
        delegate_->render(product, settings_,
                          [&](double share) { progress(baked + (1 - baked) * share); });
        return delegate_->resolve();
    }

    RenderStatistics statistics() const override { return delegate_->statistics(); }
    std::vector<std::string> notes() const override { return delegate_->notes(); }

private:
    const FlatScene& scene_;
    const RenderSettings& settings_;
    std::unique_ptr<RenderDelegate> delegate_;
    std::optional<int> syncedFrame_;
};

class ReferenceFrames final : public FrameSource {
public:
    ReferenceFrames(const FlatScene& scene, const Options& options)
        : scene_(scene), settings_(options.settings) {}

    Frame render(const RenderProduct& product, const ProgressCallback& progress) override {
        ReferenceImage image = renderReference(scene_, product, settings_, progress);
        statistics_ = image.statistics;
        if (settings_.tolerance) {
            std::ostringstream sentence;
            sentence << std::setprecision(2) << "reference: integrated to " << image.error
                     << " of a pixel's glow at worst; far windows left out bring at most "
                     << image.leftOut;
            notes_ = {sentence.str()};
        }
        return std::move(image.frame);
    }

    RenderStatistics statistics() const override { return statistics_; }
    std::vector<std::string> notes() const override { return notes_; }

private:
    const FlatScene& scene_;
    const RenderSettings& settings_;
    RenderStatistics statistics_;
    std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<FrameSource> makeFrameSource(const FlatScene& scene, const Options& options) {
    if (options.settings.method == Method::reference) {
        return std::make_unique<ReferenceFrames>(scene, options);
    }
    return std::make_unique<DeviceFrames>(scene, options);
}

}  // namespace nightcity
