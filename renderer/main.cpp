// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <iostream>
#include <new>

#include "errors.h"
#include "options.h"
#include "session.h"
#include "stop_signal.h"

namespace {

enum ExitCode { kDone = 0, kOther = 1, kUsage = 2, kScene = 3, kDevice = 4 };

int fail(int code, const char* message) {
    std::cerr << "nightcity-render: error: " << message << std::endl;
    return code;
}

int run(int argc, char** argv) {
    const auto options = nightcity::parseOptions(argc, argv, std::cout);
    if (!options) {
        return kDone;
    }
    if (options->listDevices) {
        for (const std::string& line : nightcity::listDevices()) {
            std::cout << line << "\n";
        }
        return kDone;
    }
    nightcity::watchStopSignals();
    nightcity::runSession(*options);
    return kDone;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const nightcity::Stopped& stopped) {
        return nightcity::reportStop(stopped.signal);
    } catch (const nightcity::UsageError& error) {
        return fail(kUsage, error.what());
    } catch (const nightcity::SceneError& error) {
        return fail(kScene, error.what());
    } catch (const nightcity::DeviceError& error) {
        return fail(kDevice, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kDevice, "out of memory; render a smaller --size or on a larger machine");
    } catch (const std::exception& error) {
        return fail(kOther, error.what());
    }
}
