// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/image_file.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "errors.h"
#include "output/channels.h"
#include "output/tone_map.h"
#include "output/whole_file.h"

namespace nightcity {

namespace {

constexpr char kPrefix[] = "nightcity:";

std::string describe(const ImageMetadata& metadata) {
    std::string text;
    for (const auto& [name, value] : metadata.entries) {
        text += kPrefix + name + "=" + value + "\n";
    }
    return text;
}

void addExrMetadata(OIIO::ImageSpec& spec, const ImageMetadata& metadata) {
    for (const auto& [name, value] : metadata.entries) {
        spec.attribute(kPrefix + name, value);
    }
    spec.attribute("worldToCamera", OIIO::TypeMatrix, metadata.worldToCamera.data());
    spec.attribute("worldToNDC", OIIO::TypeMatrix, metadata.worldToNdc.data());
    // Primaries and white point of Rec. 709: red, green, blue, white.
    const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
    constexpr int kDenominator = 1000;
    const double perSecond = std::min(metadata.framesPerSecond, 1e6);
    const int rate[2] = {int(perSecond * kDenominator + 0.5), kDenominator};
    spec.attribute("FramesPerSecond", OIIO::TypeRational, rate);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // or OpenImageIO puts the time of writing here
}

// Encoded in memory: the libraries below OpenImageIO end the program where a disk is full.
void store(const std::filesystem::path& file, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
           const void* pixels) {
    OIIO::Filesystem::IOVecOutput memory;
    const std::string name = file.string();
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(name, &memory);
    if (!out) {
        throw std::runtime_error(name + ": cannot be encoded: " + OIIO::geterror());
    }
    const bool written = out->open(name, spec) && out->write_image(type, pixels);
    if (!out->close() || !written) {
        throw std::runtime_error(name + ": cannot be encoded: " + out->geterror());
    }
    const std::vector<unsigned char>& bytes = memory.buffer();
    writeWholeFile(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void writeExr(const std::filesystem::path& file, const Frame& frame, const ImageMetadata& metadata,
              const ImageOptions& options) {
    const std::vector<Channel> channels = selectChannels(options.aovs);
    OIIO::ImageSpec spec(int(frame.width), int(frame.height), int(channels.size()),
                         OIIO::TypeDesc::FLOAT);
    if (options.rows.imageHeight > 0) {  // data window within the display window
        spec.y = int(options.rows.first);
        spec.full_height = int(options.rows.imageHeight);
    }
    spec.channelnames.clear();
    spec.alpha_channel = spec.z_channel = -1;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        spec.channelnames.emplace_back(channels[c].name);
        spec.alpha_channel = channels[c].name == "A" ? int(c) : spec.alpha_channel;
    }
    addExrMetadata(spec, metadata);
    const std::size_t pixels = std::size_t{frame.width} * frame.height;
    std::vector<float> values;
    values.reserve(pixels * channels.size());
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        for (const Channel& channel : channels) {
            values.push_back(channel.value(frame, pixel));
        }
    }
    store(file, spec, OIIO::TypeDesc::FLOAT, values.data());
}

void writeDisplay(const std::filesystem::path& file, const Frame& frame,
                  const ImageMetadata& metadata, const ImageOptions& options, ImageFormat format) {
    OIIO::ImageSpec spec(int(frame.width), int(frame.height), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("ImageDescription", describe(metadata));
    if (format == ImageFormat::jpeg) {
        spec.attribute("Compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    std::vector<std::uint8_t> bytes;
    bytes.reserve(frame.beauty.size() * 3);
    for (const glm::vec4& colour : frame.beauty) {
        const glm::vec3 shown = toneMap(glm::vec3(colour), options.exposure);
        for (int c = 0; c < 3; ++c) {
            bytes.push_back(std::uint8_t(shown[c] * 255 + 0.5f));
        }
    }
    store(file, spec, OIIO::TypeDesc::UINT8, bytes.data());
}

void writeCsv(const std::filesystem::path& file, const Frame& frame, const ImageOptions& options) {
    const std::vector<Channel> channels = selectChannels(options.aovs);
    std::string text = "x,y";
    for (const Channel& channel : channels) {
        text.append(",").append(channel.name);
    }
    text += "\n";
    for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
        const glm::uvec2 pixel = options.pixels.empty()
                                     ? glm::uvec2(i % frame.width, i / frame.width)
                                     : options.pixels[i];
        text += std::to_string(pixel.x) + "," + std::to_string(pixel.y);
        for (const Channel& channel : channels) {
            char value[32];
            std::snprintf(value, sizeof value, ",%.9g", double(channel.value(frame, i)));
            text += value;
        }
        text += "\n";
    }
    writeWholeFile(file, text);
}

// Whether the file ends as its format does. Decoders are no judge of that: libjpeg fills
// what is missing with grey, libpng writes to standard error.
bool hasItsEnd(const std::filesystem::path& file, ImageFormat format) {
    using namespace std::string_view_literals;
    const std::string_view end = format == ImageFormat::png    ? "IEND\xae\x42\x60\x82"sv
                                 : format == ImageFormat::jpeg ? "\xff\xd9"sv
                                                               : ""sv;
    std::ifstream in(file, std::ios::binary);
    in.seekg(-std::streamoff(end.size()), std::ios::end);
    std::string last(end.size(), '\0');
    in.read(last.data(), std::streamsize(last.size()));
    return in.good() && last == end;
}

}  // namespace

ImageFormat imageFormat(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".exr") {
        return ImageFormat::exr;
    }
    if (extension == ".png") {
        return ImageFormat::png;
    }
    if (extension == ".jpg" || extension == ".jpeg") {
        return ImageFormat::jpeg;
    }
    if (extension == ".csv") {
        return ImageFormat::csv;
    }
    throw UsageError(file.string() + ": unknown extension '" + extension +
                     "'; images end in .exr, .png, .jpg or .csv");
}

void writeImage(const std::filesystem::path& file, const Frame& frame,
                const ImageMetadata& metadata, const ImageOptions& options) {
    requireFinite(frame);
    const ImageFormat format = imageFormat(file);
    if (format == ImageFormat::exr) {
        writeExr(file, frame, metadata, options);
    } else if (format == ImageFormat::csv) {
        writeCsv(file, frame, options);
    } else {
        writeDisplay(file, frame, metadata, options, format);
    }
}

bool isWholeImage(const std::filesystem::path& file, const std::string& name,
                  const std::string& value, std::uint32_t width, std::uint32_t height,
                  const ImageRows& rows) {
    const ImageFormat format = imageFormat(file);
    if (format == ImageFormat::csv || !std::filesystem::is_regular_file(file) ||
        !hasItsEnd(file, format)) {
        return false;
    }
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(file.string());
    if (!in) {
        OIIO::geterror();  // read, or OpenImageIO prints it when the program ends
        return false;
    }
    const OIIO::ImageSpec spec = in->spec();
    const std::string entry = kPrefix + name;
    const std::string line = entry + "=" + value + "\n";
    const bool same = spec.get_string_attribute(entry) == value ||
                      spec.get_string_attribute("ImageDescription").find(line) != std::string::npos;
    const std::uint32_t imageHeight = rows.imageHeight > 0 ? rows.imageHeight : height;
    const bool placed = spec.width == int(width) && spec.height == int(height) &&
                        spec.y == int(rows.first) && spec.full_height == int(imageHeight);
    if (!same || !placed) {
        return false;
    }
    std::vector<float> pixels(std::size_t{width} * height * std::size_t(spec.nchannels));
    const bool whole = in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data());
    in->geterror();
    return in->close() && whole;
}

}  // namespace nightcity
