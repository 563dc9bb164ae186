#pragma once

#include "services/recogniser/head_model.h"
#include "services/recogniser/refined/head_geometry.h"
#include "services/recogniser/refined/refined_config.h"

namespace visavis {

/// The head that @p choice names: the generic adult, an ellipsoid or a sphere of @p sizes, or that
/// of a file. @throws FieldError under the keys refined.head.*, naming the file and what is wrong
/// with it.
HeadGeometry ChosenHead(const HeadChoice& choice, const HeadModelConfig& sizes);

}  // namespace visavis
