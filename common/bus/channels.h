#pragma once

namespace visavis {

// The channels' default names; a prefix (ROBOT1_) goes before them on the bus.
inline constexpr char kStereoImagesChannel[] = "STEREO_IMAGES";
inline constexpr char kStereoRigChannel[] = "STEREO_RIG";
inline constexpr char kArmStateChannel[] = "ARM_STATE";
inline constexpr char kCameraPoseChannel[] = "CAMERA_POSE";
inline constexpr char kHeadPoseChannel[] = "HEAD_POSE";
inline constexpr char kHeadPoseTruthChannel[] = "HEAD_POSE_TRUTH";
inline constexpr char kRecogniserTimingChannel[] = "RECOGNISER_TIMING";
inline constexpr char kRecogniserCommandChannel[] = "RECOGNISER_COMMAND";
inline constexpr char kGaPopulationChannel[] = "GA_POPULATION";
inline constexpr char kServiceStatusChannel[] = "SERVICE_STATUS";

}  // namespace visavis
