// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "image_metadata.h"

#include <sstream>

#include "choices.h"
#include "output/channels.h"
#include "scene/content_hash.h"
#include "tile.h"

namespace nightcity {

namespace {

std::string size(std::uint32_t width, std::uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

std::string number(double value) {
    std::ostringstream out;
    out.precision(9);
    out << value;
    return out.str();
}

// The rows of the view matrix as columns: row vectors times it give camera space.
glm::dmat4 worldToCamera(const CameraFrame& camera, glm::vec3 offset) {
    const glm::dvec3 position = glm::dvec3(camera.position) + glm::dvec3(offset);
    glm::dmat4 rows(1);  // rows[i] is row i of a matrix for row vectors
    const glm::dvec3 axes[3] = {glm::dvec3(camera.right), glm::dvec3(camera.up),
                                -glm::dvec3(camera.forward)};
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            rows[row][column] = axes[column][row];
        }
        rows[3][column] = -glm::dot(axes[column], position);
    }
    return rows;
}

// Camera space to NDC times depth: the inverse of the ray of docs/scene_format.md.
glm::dmat4 cameraToNdc(const CameraFrame& camera, double aspect) {
    const double tangent = camera.tanHalfFov;
    glm::dmat4 rows(0);
    rows[0][0] = 1 / (2 * tangent * aspect);
    rows[1][1] = -1 / (2 * tangent);
    rows[2][0] = -(0.5 - camera.shiftX / (2 * aspect));
    rows[2][1] = -(0.5 + camera.shiftY / 2.0);
    rows[2][2] = -1;  // z = depth - 1 m, w = depth
    rows[3][2] = -1;
    rows[2][3] = -1;
    return rows;
}

std::array<float, 16> flatten(const glm::dmat4& rows) {
    std::array<float, 16> values;
    for (int i = 0; i < 16; ++i) {
        values[std::size_t(i)] = float(rows[i / 4][i % 4]);
    }
    return values;
}

using Entries = std::vector<std::pair<std::string, std::string>>;

void addSettings(const RenderSettings& settings, Entries& entries) {
    entries.insert(
        entries.end(),
        {{"lights", choiceName(settings.model.lights)},
         {"visibility", choiceName(settings.model.visibility)},
         {"emitter", choiceName(settings.model.emitter)},
         {"scattering", choiceName(settings.model.scattering)},
         {"surfaces", choiceName(settings.model.surfaces)},
         {"media", settings.media ? "on" : settings.writeOnly ? "off, write only" : "off"},
         {"method", choiceName(settings.method)},
         settings.tolerance
             ? std::pair<std::string, std::string>("tolerance", number(*settings.tolerance))
             : std::pair<std::string, std::string>("subdivisions", std::to_string(settings.subdivisions)),
         {"lightCap", settings.lightCap ? std::to_string(*settings.lightCap) : "none"},
         {"pixelSamples", std::to_string(settings.pixelSamples)},
         {"filter", choiceName(settings.filter)},
         {"primary", choiceName(settings.primary)},
         {"seed", std::to_string(settings.seed)}});
    if (settings.reach) {
        entries.emplace_back("reach", number(*settings.reach));
    }
    if (settings.method == Method::path) {
        const Orders& orders = settings.orders;
        const bool single = settings.model.scattering == Scattering::single;
        entries.emplace_back("samples", std::to_string(settings.samples));
        entries.emplace_back("orders", std::to_string(orders.first) + "-" +
                                           (orders.last ? std::to_string(*orders.last)
                                            : single    ? "1"
                                                        : ""));
        entries.emplace_back("g", number(settings.anisotropy));
    }
    if (settings.method == Method::field) {
        entries.emplace_back("glowRays", choiceName(settings.glowRays));
        if (settings.bricks) {
            entries.emplace_back("bricks", std::to_string(*settings.bricks));
        }
    }
    if (settings.method == Method::march) {
        entries.emplace_back("marchOrder", choiceName(settings.marchOrder));
    }
    if (settings.method == Method::march || settings.method == Method::gauss) {
        entries.emplace_back("lightStorage", choiceName(settings.lightStorage));
    }
}

void addImage(const ImageOptions& image, ImageFormat format, Entries& entries) {
    if (!image.choice.empty()) {
        entries.emplace_back("choice", image.choice);
    }
    if (format == ImageFormat::png || format == ImageFormat::jpeg) {
        entries.emplace_back("exposure", number(image.exposure));
        entries.emplace_back("toneMap", "Khronos PBR Neutral");
        return;
    }
    std::string channels;
    for (const Channel& channel : selectChannels(image.aovs)) {
        channels.append(channels.empty() ? "" : ",").append(channel.name);
    }
    entries.emplace_back("channels", channels);
}

}  // namespace

ImageMetadata describeImage(const FlatScene& scene, const RenderProduct& product,
                            const RenderSettings& settings, const ImageOptions& image,
                            ImageFormat format, std::optional<Tile> tile) {
    const CameraFrame& camera = scene.camera(product.camera).at(product.frame);
    ImageMetadata metadata;
    metadata.entries = {{"version", "nightcity-render " NIGHTCITY_VERSION},
                        {"sceneGenerator", scene.generator},
                        {"sceneHash", scene.hash},
                        {"camera", product.camera},
                        {"frame", std::to_string(product.frame)},
                        {"size", size(product.width, product.height)}};
    addSettings(settings, metadata.entries);
    addImage(image, format, metadata.entries);
    std::string all;
    for (const auto& [name, value] : metadata.entries) {
        all += name + "=" + value + "\n";
    }
    if (tile) {
        metadata.entries.emplace_back("tile", tileName(*tile));
    }
    metadata.entries.emplace_back("settingsHash", contentHash(all));
    const glm::dmat4 view = worldToCamera(camera, product.cameraOffset);
    const double aspect = double(product.width) / product.height;
    metadata.worldToCamera = flatten(view);
    // Rows as columns of GLM: the product of matrices for row vectors turns around.
    metadata.worldToNdc = flatten(cameraToNdc(camera, aspect) * view);
    metadata.framesPerSecond = scene.frames.perSecond;
    return metadata;
}

}  // namespace nightcity
