#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace visavis {

/// A message that decodes but makes no sense: names field, value and rule.
class MessageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// @throws MessageError "field: value: rule" unless @p holds.
template <typename T>
void RequireField(bool holds, const char* field, const T& value, const char* rule) {
  if (holds) return;
  std::ostringstream text;
  text << field << ": " << value << ": " << rule;
  throw MessageError(text.str());
}

}  // namespace visavis
