#include "services/recogniser/refined/eye.h"

namespace visavis {

EyeGeometry::EyeGeometry(const Pinhole& camera, const RigidTransform& X_CE)
    : width(camera.width),
      height(camera.height),
      fx(static_cast<float>(camera.fx)),
      fy(static_cast<float>(camera.fy)),
      cx(static_cast<float>(camera.cx)),
      cy(static_cast<float>(camera.cy)),
      R_EC(X_CE.linear().transpose().cast<float>()),
      p_EC(X_CE.inverse().translation().cast<float>()) {}

EyePose::EyePose(const EyeGeometry& eye, const RigidTransform& X_CM)
    : R_CM(X_CM.linear().cast<float>()),
      R_EM(eye.R_EC * R_CM),
      p_EM(eye.R_EC * X_CM.translation().cast<float>() + eye.p_EC),
      p_ME(-R_EM.transpose() * p_EM) {}

}  // namespace visavis
