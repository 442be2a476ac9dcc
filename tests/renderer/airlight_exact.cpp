// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The integrals of airlight_cases.h by adaptive quadrature in double precision: on
// exactly the numbers that the float formulas are given.
#include <algorithm>
#include <cmath>

#include "airlight_cases.h"
#include "reference/adaptive_quadrature.h"

namespace nightcity {

namespace {

// The end of an interval whose end is given twice, once as the nearer to the foot and
// once by the span: each is the more exact where the other is a difference.
double endOf(const AirlightInterval& i) {
    const double ua = i.ua, ub = i.ub;
    return std::abs(ub) < 0.5 * std::abs(ua) ? ub : ua + double(i.span);
}

// Int lobe(u) exp(-tau (t + d)) / d^2 dt over ua <= u <= ub.
template <typename Lobe>
double pointIntegral(double h, double ua, double ub, double begin, double tau, Lobe&& lobe) {
    const double span = ub - ua;
    const double da = std::hypot(h, ua);
    const double whole = std::atan2(h * span, h * h + ua * ub);
    const auto stepOf = [&](double angle) {
        const double across = std::max(h * std::cos(angle) - ua * std::sin(angle), 1e-300);
        return std::clamp(std::sin(angle) * da * da / across, 0.0, span);
    };
    const auto integrand = [&](double angle) {
        const double step = stepOf(angle);
        const double d = std::hypot(h, ua + step);
        const double detour = step * (1 + (2 * ua + step) / (da + d));
        return lobe(ua + step, d) * std::exp(-tau * detour);
    };
    std::vector<double> breaks{0, whole};
    for (const double share : {0.25, 0.5, 0.75}) {
        breaks.push_back(share * whole);
    }
    const double reach = ua < 0 ? h * h / (da - ua) : ua + da;
    for (double depth = 0.01; tau > 0 && depth < 50; depth *= 2) {
        const double far = reach + depth / tau;
        const double u = 0.5 * (far - h * h / far);
        if (u < ub) {
            breaks.push_back(std::atan2(h * (u - ua), h * h + ua * u));
        }
    }
    for (double& angle : breaks) {
        angle = std::clamp(angle, 0.0, whole);
    }
    std::sort(breaks.begin(), breaks.end());
    const double value = integrate(integrand, breaks, Tolerance{0, 1e-8}).value;
    return value / h * std::exp(-tau * (begin + da));
}

double solidAngle(glm::dvec3 x, double a, double b) {
    const auto corner = [&](double p, double q) {
        return std::atan2(p * q, x.z * std::sqrt(p * p + q * q + x.z * x.z));
    };
    return corner(a - x.x, b - x.y) + corner(a + x.x, b - x.y) + corner(a - x.x, b + x.y) +
           corner(a + x.x, b + x.y);
}

// Breaks of [-half, half] that crowd towards `centre`, down to a third of `finest`.
std::vector<double> crowdedBreaks(double half, double centre, double finest) {
    std::vector<double> breaks{-half, half, std::clamp(centre, -half, half)};
    for (double away = finest; away < 2 * half; away *= 3) {
        for (const double at : {centre - away, centre + away}) {
            if (std::abs(at) < half) {
                breaks.push_back(at);
            }
        }
    }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

struct WeightedNode {
    double at, weight;
};

std::vector<WeightedNode> gaussNodes(const std::vector<double>& breaks) {
    constexpr double kNode[4] = {0.069431844202973712, 0.330009478207571868, 0.669990521792428132,
                                 0.930568155797026288};
    constexpr double kWeight[4] = {0.173927422568726929, 0.326072577431273071,
                                   0.326072577431273071, 0.173927422568726929};
    std::vector<WeightedNode> nodes;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const double width = breaks[i + 1] - breaks[i];
        for (int k = 0; k < 4 && width > 0; ++k) {
            nodes.push_back({breaks[i] + width * kNode[k], width * kWeight[k]});
        }
    }
    return nodes;
}

// Int exp(-tau d) domega over the pane.
double attenuatedSolidAngle(glm::dvec3 x, double a, double b, double tau) {
    if (tau == 0) {
        return solidAngle(x, a, b);
    }
    const double finest = std::max(0.3 * x.z, 1e-7);
    const std::vector<WeightedNode> columns = gaussNodes(crowdedBreaks(a, x.x, finest));
    const std::vector<WeightedNode> rows = gaussNodes(crowdedBreaks(b, x.y, finest));
    double sum = 0;
    for (const WeightedNode& p : columns) {
        for (const WeightedNode& q : rows) {
            const double d = glm::length(x - glm::dvec3(p.at, q.at, 0));
            sum += p.weight * q.weight * std::exp(-tau * d) * x.z / (d * d * d);
        }
    }
    return sum;
}

// Places along a ray to look at more closely: its nearest points to the pane's corners,
// its crossings of the planes through the edges, and the flanks of each.
std::vector<double> paneBreaks(glm::dvec3 origin, glm::dvec3 direction, double a, double b,
                               double end) {
    std::vector<double> places{-glm::dot(origin, direction)};
    for (const double p : {-a, a}) {
        for (const double q : {-b, b}) {
            places.push_back(glm::dot(glm::dvec3(p, q, 0) - origin, direction));
        }
        places.push_back((p - origin.x) / direction.x);
    }
    for (const double q : {-b, b}) {
        places.push_back((q - origin.y) / direction.y);
    }
    std::vector<double> breaks{0, end};
    for (const double place : places) {
        for (const double away : {0.0, 0.01, 0.1, 1.0, 10.0}) {
            breaks.push_back(std::clamp(place - away, 0.0, end));
            breaks.push_back(std::clamp(place + away, 0.0, end));
        }
    }
    std::sort(breaks.begin(), breaks.end());
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    return breaks;
}

}  // namespace

double exactIsotropic(const PointCase& c) {
    const AirlightInterval& i = c.interval;
    return pointIntegral(i.h, i.ua, endOf(i), i.begin, c.extinction,
                         [](double, double) { return 1.0; });
}

double exactLambertian(const PointCase& c) {
    const AirlightInterval& i = c.interval;
    const double atFoot = glm::dot(glm::dvec3(c.normal), glm::dvec3(i.foot));
    const double slope = glm::dot(glm::dvec3(c.normal), glm::dvec3(c.direction));
    double low = i.ua, high = endOf(i);
    if (slope > 0) {
        low = std::max(low, -atFoot / slope);
    } else if (slope < 0) {
        high = std::min(high, -atFoot / slope);
    } else if (atFoot <= 0) {
        return 0;
    }
    if (low >= high) {
        return 0;
    }
    return pointIntegral(i.h, low, high, i.begin + (low - double(i.ua)), c.extinction,
                         [&](double u, double d) { return std::max(atFoot + slope * u, 0.0) / d; });
}

double exactPane(const PaneCase& c) {
    const double a = glm::length(glm::dvec3(c.halfU)), b = glm::length(glm::dvec3(c.halfV));
    const glm::dvec3 u = glm::dvec3(c.halfU) / a, v = glm::dvec3(c.halfV) / b;
    const glm::dvec3 n = glm::cross(u, v);
    const glm::dvec3 w = glm::normalize(glm::dvec3(c.direction));
    const glm::dvec3 from = glm::dvec3(c.fromCentre) + double(c.begin) * w;
    const glm::dvec3 origin(glm::dot(from, u), glm::dot(from, v), glm::dot(from, n));
    const glm::dvec3 direction(glm::dot(w, u), glm::dot(w, v), glm::dot(w, n));
    const double tau = c.extinction;
    const auto integrand = [&](double t) {
        const glm::dvec3 x = origin + t * direction;
        return x.z <= 0 ? 0.0 : attenuatedSolidAngle(x, a, b, tau) * std::exp(-tau * (c.begin + t));
    };
    std::vector<double> breaks = paneBreaks(origin, direction, a, b, double(c.end) - c.begin);
    return integrate(integrand, breaks, Tolerance{0, tau == 0 ? 1e-7 : 1e-5}).value / (4 * a * b);
}

}  // namespace nightcity
