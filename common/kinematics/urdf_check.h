#pragma once

// Internal to common/kinematics: what a URDF from outside must pass before urdfdom reads it.

#include <string>

namespace visavis {

/// Outside text as one short printable line, @p max_length characters and "..." at most.
std::string Printable(const std::string& text, std::size_t max_length = 200);

/// A name from outside, as a short line in quotes.
std::string Quoted(const std::string& name);

/// @throws std::invalid_argument("arm: " + @p what).
[[noreturn]] void RefuseArm(const std::string& what);

/// Refuses what urdfdom and TinyXML cannot bear: too long a text, elements nested or links chained
/// so deeply that recursion would overflow the stack, links with two parents (it keeps one and says
/// nothing), cycles (it never frees them).
/// @throws std::invalid_argument, one line naming what, value and rule.
void CheckUrdf(const std::string& urdf);

}  // namespace visavis
