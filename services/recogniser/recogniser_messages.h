#pragma once

#include <vector>

#include "services/recogniser/ego_motion.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/stage_timer.h"
#include "visavis/ga_population_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/recogniser_command_t.hpp"
#include "visavis/recogniser_timing_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// Status, pose, covariance, fitness and counts of @p estimate.
void FillHeadPose(const Estimate& estimate, head_pose_t* message);

/// Durations of the stages.
void FillTiming(const StageTimer& timer, recogniser_timing_t* message);

/// The individuals; the message's memory is reused.
void FillPopulation(const std::vector<Individual>& population, ga_population_t* message);

/// head_pose_t's SOURCE code.
std::int8_t SourceCode(EgoMotionSource source, bool missing);

/// @throws MessageError where the box is empty, not finite or behind the camera.
SearchSpace SearchSpaceFromMessage(const recogniser_command_t& message);

/// Whether two messages describe the same rig (their times may differ).
bool SameRig(const stereo_rig_t& a, const stereo_rig_t& b);

}  // namespace visavis
