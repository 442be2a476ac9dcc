// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/statistics.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "output/whole_file.h"

namespace nightcity {

namespace {

// Linear between the two nearest ranks; 0 of no values.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0;
    }
    std::sort(values.begin(), values.end());
    const double place = share * double(values.size() - 1);
    const std::size_t below = std::size_t(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
}

// Render calls after the first, which pays for compiling and first use; the first
// where there is no other.
std::vector<RenderStatistics> steadyFrames(const std::vector<RenderStatistics>& frames) {
    return frames.size() == 1 ? frames
                              : std::vector<RenderStatistics>(frames.begin() + 1, frames.end());
}

// Over the frames that have such a pass.
double medianOfPass(const std::vector<RenderStatistics>& frames, const std::string& name) {
    std::vector<double> milliseconds;
    for (const RenderStatistics& frame : frames) {
        for (const PassTime& pass : frame.passes) {
            if (pass.name == name) {
                milliseconds.push_back(pass.milliseconds);
            }
        }
    }
    return quantile(std::move(milliseconds), 0.5);
}

nlohmann::ordered_json timing(const StatisticsReport& report) {
    const std::vector<RenderStatistics> steady = steadyFrames(report.frames);
    std::vector<double> milliseconds;
    for (const RenderStatistics& frame : steady) {
        milliseconds.push_back(frame.frameMilliseconds);
    }
    // The first as well where there is no other, as steadyFrames has it.
    const std::vector<double> processor(report.processorMilliseconds.end() -
                                            std::ptrdiff_t(steady.size()),
                                        report.processorMilliseconds.end());
    nlohmann::ordered_json passes = nlohmann::ordered_json::object();
    for (const PassTime& pass : report.frames.back().passes) {
        passes[pass.name] = medianOfPass(steady, pass.name);
    }
    nlohmann::ordered_json bakePasses = nlohmann::ordered_json::object();
    for (const PassTime& pass : report.frames.front().bakePasses) {
        bakePasses[pass.name] = pass.milliseconds;
    }
    return {{"load_ms", report.loadMilliseconds},
            {"bake_ms", report.bakeMilliseconds},
            {"bake_passes", bakePasses},
            {"bake_updates", report.updateMilliseconds.size()},
            {"bake_update_ms", quantile(report.updateMilliseconds, 0.5)},
            {"first_frame_ms", report.frames.front().frameMilliseconds},
            {"steady_frame_ms", quantile(milliseconds, 0.5)},
            {"steady_frames", milliseconds.size()},
            {"spread_ms", quantile(milliseconds, 0.75) - quantile(milliseconds, 0.25)},
            {"worst_frame_ms", quantile(milliseconds, 1)},
            {"frame_processor_ms", quantile(processor, 0.5)},
            {"worst_frame_processor_ms", quantile(processor, 1)},
            {"passes", passes}};
}

// Not getrusage's: that counts what the process held that started this one. 0 where the system
// does not say.
std::uint64_t peakHostBytes() {
    std::ifstream status("/proc/self/status");
    std::uint64_t kibibytes = 0;
    for (std::string key; status >> key;) {
        if (key == "VmHWM:") {
            status >> kibibytes;
            break;
        }
    }
    return kibibytes * 1024;
}

}  // namespace

void writeStatistics(const std::filesystem::path& file, const StatisticsReport& report) {
    const RenderStatistics& last = report.frames.back();
    const nlohmann::ordered_json times = timing(report);
    const double seconds = times["steady_frame_ms"].get<double>() / 1000;
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    for (const auto& [name, value] : report.settings) {
        settings[name] = value;
    }
    const nlohmann::ordered_json json = {
        {"device", last.device},
        {"settings", settings},
        {"counts",
         {{"buildings", report.buildings},
          {"windows", report.windows},
          {"media_boxes", report.mediaBoxes},
          {"triangles", report.triangles},
          {"light_list_entries", report.lightListEntries},
          {"light_pages", last.lightPages},
          {"light_evaluations", last.lightEvaluations},
          {"far_field_bricks", last.farFieldBricks}}},
        {"timing", times},
        {"memory",
         {{"device_bytes", last.deviceMemoryBytes},
          {"planned_bytes", last.plannedBytes},
          {"device_peak_bytes", last.devicePeakBytes},
          {"device_bytes_by_name", last.deviceMemory},
          {"far_field_bytes", last.farFieldBytes},
          {"host_peak_bytes", peakHostBytes()}}},
        {"light_storage", last.lightStorage},
        {"light_evaluations_per_second", seconds > 0 ? double(last.lightEvaluations) / seconds : 0},
        {"notes", report.notes}};
    writeWholeFile(file, json.dump(2) + "\n");
}

}  // namespace nightcity
