// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The judge: single scattering and direct light on surfaces, integrated to a stated
// error, for whatever the model says of lights, visibility, emitters and surfaces.
#pragma once

#include "reference/light_scene.h"
#include "reference/media_segments.h"
#include "reference/opaque_surfaces.h"
#include "reference/ray_integrator.h"
#include "reference/single_scattering.h"
#include "reference/surface_light.h"

namespace nightcity {

// How exact a judge of `tolerance` must be: a tenth of it; what is left out brings
// less than a millionth, in scenes of more than 10,000 windows less than a
// hundredth of the tolerance.
Accuracy judgeAccuracy(double tolerance, std::size_t windows);

class ExactIntegral : public RayIntegrator {
public:
    // The scene must outlive it.
    ExactIntegral(const FlatScene& scene, int frame, const RenderSettings& settings,
                  const Accuracy& accuracy);

    // lightEvaluations counts windows that were integrated.
    RayResult trace(const Ray& ray) const override;

    const MediaSegments& segments() const { return segments_; }
    const SingleScattering& scattering() const { return scattering_; }

private:
    bool media_;
    OpaqueSurfaces surfaces_;
    MediaSegments segments_;
    LightScene lights_;
    SingleScattering scattering_;
    SurfaceLight surfaceLight_;
};

}  // namespace nightcity
