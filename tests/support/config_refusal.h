#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "common/config/config_error.h"

namespace visavis {

/// Expects that @p check throws a FieldError that names @p key, a value that holds @p value and a
/// rule that holds @p rule.
inline void ExpectRefusal(const std::function<void()>& check, const std::string& key,
                          const std::string& value, const std::string& rule) {
  try {
    check();
    ADD_FAILURE() << key << " = " << value << " was taken";
  } catch (const FieldError& e) {
    EXPECT_EQ(e.key(), key);
    EXPECT_THAT(e.value(), ::testing::HasSubstr(value));
    EXPECT_THAT(e.rule(), ::testing::HasSubstr(rule));
  }
}

}  // namespace visavis
