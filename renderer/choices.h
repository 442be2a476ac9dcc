// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The names that options and metadata give to enumerators: one table each. A value
// that the renderer does not know yet is in no table, and so refused by name.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "options.h"

namespace nightcity {

template <typename Value>
struct Choice {
    std::string_view name;
    Value value;
};

template <typename Value>
inline constexpr std::span<const Choice<Value>> kChoices{};

#define NIGHTCITY_CHOICES(Value, ...)                                    \
    inline constexpr Choice<Value> k##Value##Names[] = {__VA_ARGS__};    \
    template <>                                                          \
    inline constexpr std::span<const Choice<Value>> kChoices<Value>{k##Value##Names};

NIGHTCITY_CHOICES(Lights, {"listed", Lights::listed}, {"all", Lights::all})
NIGHTCITY_CHOICES(Visibility, {"none", Visibility::none}, {"full", Visibility::full})
NIGHTCITY_CHOICES(Emitter, {"isotropic", Emitter::isotropic},
                  {"lambertian", Emitter::lambertian}, {"pane", Emitter::pane})
NIGHTCITY_CHOICES(Scattering, {"single", Scattering::single},
                  {"multiple", Scattering::multiple})
NIGHTCITY_CHOICES(Surfaces, {"dim", Surfaces::dim}, {"lit", Surfaces::lit})
NIGHTCITY_CHOICES(Method, {"march", Method::march}, {"gauss", Method::gauss},
                  {"field", Method::field}, {"path", Method::path},
                  {"reference", Method::reference})
NIGHTCITY_CHOICES(MarchOrder, {"steps", MarchOrder::steps}, {"lights", MarchOrder::lights})
NIGHTCITY_CHOICES(LightStorage, {"uniform", LightStorage::uniform},
                  {"storage", LightStorage::storage})
NIGHTCITY_CHOICES(Filter, {"box", Filter::box}, {"gauss", Filter::gauss})
NIGHTCITY_CHOICES(GlowRays, {"sparse", GlowRays::sparse}, {"all", GlowRays::all})
NIGHTCITY_CHOICES(Primary, {"raster", Primary::raster}, {"rays", Primary::rays})
NIGHTCITY_CHOICES(ProgressStyle, {"auto", ProgressStyle::automatic},
                  {"tty", ProgressStyle::terminal}, {"lines", ProgressStyle::lines},
                  {"farm", ProgressStyle::farm},
                  {"none", ProgressStyle::none})

#undef NIGHTCITY_CHOICES

// "a, b or c": `between` joins the names, `last` the last two.
template <typename Value>
std::string choiceNames(std::string_view between, std::string_view last) {
    std::string names;
    const auto choices = kChoices<Value>;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        names += i == 0 ? "" : i + 1 == choices.size() ? last : between;
        names += choices[i].name;
    }
    return names;
}

// Of a value that the command line can set: it has its row above.
template <typename Value>
std::string choiceName(Value value) {
    const auto choices = kChoices<Value>;
    const auto found = std::find_if(choices.begin(), choices.end(),
                                    [&](const Choice<Value>& c) { return c.value == value; });
    return std::string(found->name);
}

}  // namespace nightcity
