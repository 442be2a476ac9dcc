// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>

#include <CLI/CLI.hpp>

#include "choices.h"
#include "defaults.h"
#include "errors.h"
#include "frame_names.h"
#include "nearest_name.h"
#include "option_checks.h"

namespace nightcity {

namespace {

constexpr std::uint32_t kMaxSide = 65536;                        // pixels
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;     // of one image
constexpr double kDefaultTolerance = 0.01;  // relative
constexpr std::uint32_t kMaxCount = 1u << 24;  // of steps, samples, repeats, pixels, lights

std::optional<std::uint32_t> wholeNumber(std::string_view text) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return value;
}

glm::uvec2 parseSize(const std::string& text) {
    const std::size_t cross = text.find('x');
    const auto width = wholeNumber(std::string_view(text).substr(0, cross));
    const auto height = cross == std::string::npos
                            ? std::nullopt
                            : wholeNumber(std::string_view(text).substr(cross + 1));
    if (!width || !height || *width == 0 || *height == 0 || *width > kMaxSide ||
        *height > kMaxSide || std::uint64_t{*width} * *height > kMaxPixels) {
        throw UsageError("--size " + text +
                         ": give WIDTHxHEIGHT in pixels, like 1920x1061; each from 1 to 65536, "
                         "together at most 268435456");
    }
    return {*width, *height};
}

// Bytes; K, M, G and T are powers of 1024.
std::uint64_t parseMemory(const std::string& text) {
    double value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    const std::string_view unit(end, std::size_t(last - end));
    const std::size_t power = unit.empty() ? 0 : std::string_view("KMGT").find(unit) + 1;
    const double bytes = std::ldexp(value, 10 * int(power));
    if (error != std::errc() || unit.size() > 1 || (power == 0 && !unit.empty()) ||
        !(bytes >= 1 && bytes < 1e18)) {
        throw UsageError("--memory " + text + ": give bytes, or a number with K, M, G or T behind it, "
                         "like 4G or 500M");
    }
    return static_cast<std::uint64_t>(bytes);
}

Orders parseOrders(const std::string& text) {
    const std::size_t dash = text.find('-');
    const auto first = wholeNumber(std::string_view(text).substr(0, dash));
    const bool open = dash != std::string::npos && dash + 1 == text.size();
    const auto last = dash == std::string::npos ? first
                      : open ? std::nullopt : wholeNumber(std::string_view(text).substr(dash + 1));
    if (!first || *first == 0 || (!open && (!last || *last < *first))) {
        throw UsageError("--orders " + text + ": give orders like 1, 2-5 or 2-, from 1 up");
    }
    return {*first, last};
}

template <typename Value>
CLI::Option* addChoice(CLI::App& app, const std::string& name, Value& target,
                       const std::string& help) {
    const auto set = [&target, name](const std::string& text) {
        for (const Choice<Value>& choice : kChoices<Value>) {
            if (choice.name == text) {
                target = choice.value;
                return;
            }
        }
        throw UsageError(name + " " + text + " is not known; there is " +
                         choiceNames<Value>(", ", " and "));
    };
    return app.add_option_function<std::string>(name, set, help)
        ->type_name(choiceNames<Value>("|", "|"))
        ->default_str(choiceName(target));
}

CLI::Option* addCount(CLI::App& app, const std::string& name, std::uint32_t& target,
                      const std::string& help) {
    return app.add_option(name, target, help)
        ->check(CLI::Range(1u, kMaxCount).description(""))
        ->capture_default_str()
        ->type_name("N");
}

void addWhat(CLI::App& app, Options& options) {
    app.add_option("scene", options.scene, "the flat scene: a folder that 'nightcity export' wrote")
        ->type_name("FOLDER");
    app.add_option("-o,--output", options.output,
                   "image (.exr, .png, .jpg) or table (.csv, with --pixels); #### or %04d stands "
                   "for the frame")
        ->type_name("FILE");
    app.add_option("--camera", options.camera, "camera (default: the stage's, else the first)")
        ->type_name("NAME");
    app.add_option_function<std::string>(
           "--size", [&](const std::string& text) { options.size = parseSize(text); },
           "pixels (default: the stage's, else 1920x1061)")
        ->type_name("WIDTHxHEIGHT");
    app.add_option_function<std::string>(
           "--frames", [&](const std::string& text) { options.frames = parseFrames(text); },
           "like 1-10, 1-10x2 or 1,5,20-30 (default: the stage's first)")
        ->type_name("FRAMES");
    app.add_option_function<std::string>(
           "--tile", [&](const std::string& text) { options.tile = parseTile(text); },
           "one of N bands of rows, as FRAME.IofN.exr; 'nightcity stitch' joins them")
        ->type_name("I/N");
    app.add_option_function<std::string>(
           "--pixels",
           [&](const std::string& text) {
               options.pixelCount = wholeNumber(text);
               if (!options.pixelCount) {
                   options.pixelFile = text;
               }
           },
           "only so many random pixels that see a medium, or those of a file of lines x,y")
        ->type_name("N|FILE");
    app.add_option("--aovs", options.aovs,
                   "channels, separated by commas: beauty, glow, surface, transmittance, depth, "
                   "normal, mediaId, materialId, of --method path glowError, of --method field error "
                   "and cost (default: the stage's, else all but the last three)")
        ->delimiter(',')
        ->type_name("NAMES");
}

// CLI11 hands values on in the order of these calls: the switches after --model,
// wherever they stand on the command line.
void addModel(CLI::App& app, Options& options) {
    Model& model = options.settings.model;
    model = kSingleModel;
    app.add_option_function<std::string>(
           "--model",
           [&model](const std::string& text) {
               if (text == "paper") {
                   model = {};
               } else if (text == "single") {
                   model = kSingleModel;
               } else if (text == "full") {
                   model = kSingleModel;
                   model.scattering = Scattering::multiple;
                   model.surfaces = Surfaces::lit;
               } else {
                   throw UsageError("--model " + text +
                                    " is not known; there is paper, single and full");
               }
           },
           "which physics: paper is --lights listed --visibility none --emitter isotropic "
           "--scattering single --surfaces dim; single is all, full, pane, single, dim; full is all, "
           "full, pane, multiple, lit")
        ->type_name("paper|single|full")
        ->default_str("single; of the march paper");
    addChoice(app, "--lights", model.lights, "which windows light a point");
    addChoice(app, "--visibility", model.visibility, "what hides them");
    addChoice(app, "--emitter", model.emitter, "how a window shines");
    addChoice(app, "--scattering", model.scattering, "orders of scattering");
    addChoice(app, "--surfaces", model.surfaces, "how walls and ground are shown");
    app.add_option_function<std::string>(
           "--media",
           [&](const std::string& text) {
               if (text != "on" && text != "off") {
                   throw UsageError("--media " + text + " is not known; there is on and off");
               }
               options.settings.media = text == "on";
           },
           "off: the surface frame, without haze")
        ->type_name("on|off")
        ->default_str("on");
    app.add_flag("--write-only", options.settings.writeOnly,
                 "with --media off: write the same images and look at nothing, for timing");
}

void addMethod(CLI::App& app, Options& options) {
    RenderSettings& settings = options.settings;
    addChoice(app, "--method", settings.method,
              "march, quadrature to a tolerance, field or Monte Carlo paths on the device; or in double "
              "precision on the CPU the exact integral, with --subdivisions the same march. Default: "
              "gauss for --lights listed, --reach and tolerances below 0.01; of --scattering "
              "multiple path for --lights listed, --reach and --surfaces lit, and with --samples, "
              "--orders, --g or --aovs glowError; else field")
        ->default_str("by the model");
    addCount(app, "--subdivisions", settings.subdivisions, "steps of the march in each media box");
    app.add_option("--tolerance", settings.tolerance,
                   "relative error of the glow, of --method gauss and, in 95 of 100 pixels, field (its "
                   "baked part in 99, down to 0.01); of what the reference shall judge: it is exact to "
                   "a tenth of it (default 0.01)")
        ->type_name("T");
    addChoice(app, "--march-order", settings.marchOrder, "which loop of the march is outside");
    app.add_option("--light-cap", settings.lightCap, "at most so many lit windows a media box")
        ->check(CLI::Range(1u, kMaxCount).description(""))
        ->type_name("N");
    app.add_option("--reach", settings.reach,
                   "with --lights all: no window lights what is farther than this from its centre "
                   "(default: no limit)")
        ->type_name("METRES");
    addCount(app, "--samples", settings.samples, "paths a pixel sample, of --method path");
    app.add_option_function<std::string>(
           "--orders", [&](const std::string& text) { settings.orders = parseOrders(text); },
           "only paths with so many events between window and eye: 1, 2-5 or 2-")
        ->type_name("A-B");
    app.add_option("--g", settings.anisotropy,
                   "of the phase function of Henyey and Greenstein, -0.99 to 0.99; 0: isotropic")
        ->type_name("G");
    addChoice(app, "--light-storage", settings.lightStorage, "buffers of the light lists");
    addChoice(app, "--glow-rays", settings.glowRays,
              "of --method field: the rays along which glow is integrated, others interpolated");
    app.add_option("--bricks", settings.bricks,
                   "of --method field: at most so many bricks of its baked part, which near the camera "
                   "are as fine as --tolerance asks (default: 6000, of more than 50,000 windows 2000)")
        ->check(CLI::Range(kLeastBricks, kMostBricks).description(""))
        ->type_name("N");
    addChoice(app, "--primary", settings.primary,
              "how the device finds what the camera sees; raster where it can, else rays");
    addCount(app, "--pixel-samples", settings.pixelSamples, "rays a pixel");
    addChoice(app, "--filter", settings.filter, "where in the pixel they lie");
    app.add_option("--seed", settings.seed, "shifts whatever is random")->capture_default_str();
    addCount(app, "--repeat", options.repeat,
             "render so often for timing, the camera 0.1 m further each; the first is written");
}

void addRun(CLI::App& app, Options& options, bool& quiet) {
    app.add_option("--exposure", options.exposure, "PNG and JPEG: radiance times 2^EV")
        ->type_name("EV")
        ->capture_default_str();
    app.add_option("--device", options.device.device, "part of a name, or a number of --list-devices")
        ->type_name("DEVICE");
    app.add_option_function<std::string>(
           "--memory",
           [&](const std::string& text) { options.device.memoryBytes = parseMemory(text); },
           "most that is held on the device, like 4G: what needs more is refused before work starts, "
           "with the figure (exit code 4); the picture does not depend on it (default: no limit)")
        ->type_name("SIZE");
    app.add_flag("--list-devices", options.listDevices, "list the devices and what they lack");
    app.add_flag("--validation", options.device.validation,
                 "Vulkan's validation layers; a message is an error");
    app.add_option("--stats", options.stats, "write times, counts and memory as JSON")
        ->type_name("FILE");
    app.add_flag("--skip-existing", options.skipExisting,
                 "keep images that are there, whole and of the same settings");
    app.add_flag("--list-missing", options.listMissing,
                 "render nothing: list the images that are not there, or not whole, or of other "
                 "settings; exit code 1 if there are any");
    app.add_option("--choice", options.choice,
                   "how these settings were chosen, for the image's metadata")
        ->type_name("TEXT");
    addChoice(app, "--progress", options.progress, "how progress is shown");
    app.add_flag("--quiet", quiet, "no progress, no notes");
}

// Of the march and its model: --subdivisions makes the reference march.
bool isMarch(const RenderSettings& settings, const Given& given) {
    return settings.method == Method::march ||
           (settings.method == Method::reference && given("--subdivisions"));
}

void fillIn(Options& options, const Given& given) {
    RenderSettings& settings = options.settings;
    if (!given("--method")) {
        settings.method = defaultMethod(settings, asksForPaths(options, given));
    }
    if (isMarch(settings, given) && !given("--model")) {
        const Model paper;
        Model& model = settings.model;
        model.lights = given("--lights") ? model.lights : paper.lights;
        model.visibility = given("--visibility") ? model.visibility : paper.visibility;
        model.emitter = given("--emitter") ? model.emitter : paper.emitter;
    }
}

// For the first option that is not known: the one that may be meant.
std::string suggestion(const CLI::App& app) {
    const std::vector<std::string> unknown = app.remaining();
    const auto option = std::find_if(unknown.begin(), unknown.end(), [](const std::string& text) {
        return text.starts_with("--");
    });
    if (option == unknown.end()) {
        return "";
    }
    std::vector<std::string> names;
    for (const CLI::Option* known : app.get_options()) {
        for (const std::string& name : known->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    const std::string nearest = nearestName(option->substr(0, option->find('=')), names);
    return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv, std::ostream& out) {
    CLI::App app("Renders the glow of a city at night from a flat scene.", "nightcity-render");
    app.set_version_flag("--version", "nightcity-render " NIGHTCITY_VERSION);
    Options options;
    bool quiet = false;
    addWhat(app, options);
    addModel(app, options);
    addMethod(app, options);
    addRun(app, options, quiet);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        out << app.help();
        return std::nullopt;
    } catch (const CLI::CallForVersion&) {
        out << app.version() << "\n";
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        throw UsageError(error.what() + suggestion(app) + "; see nightcity-render --help");
    }
    if (quiet) {
        options.progress = ProgressStyle::none;
    }
    const Given given = [&](const char* name) { return app.count(name) > 0; };
    RenderSettings& settings = options.settings;
    fillIn(options, given);
    checkCombinations(options, given);
    const bool toTolerance = settings.method != Method::path && !isMarch(settings, given);
    if (toTolerance && !settings.tolerance) {
        settings.tolerance = kDefaultTolerance;
    }
    return options;
}

}  // namespace nightcity
