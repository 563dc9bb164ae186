#pragma once

#include <arv.h>

#include <memory>
#include <string>

namespace visavis {

struct UnrefObject {
  void operator()(gpointer object) const { g_object_unref(object); }
};
/// Owns one reference to a GObject.
template <typename T>
using ObjectPtr = std::unique_ptr<T, UnrefObject>;

struct FreeMemory {
  void operator()(gpointer memory) const { g_free(memory); }
};
/// Owns memory of GLib's.
template <typename T>
using GlibPtr = std::unique_ptr<T, FreeMemory>;

/// Takes a call's error: `arv_x(..., error.out())`, then `if (error)`.
class GlibError {
 public:
  GlibError() = default;
  ~GlibError() { g_clear_error(&error_); }
  GlibError(const GlibError&) = delete;
  GlibError& operator=(const GlibError&) = delete;

  /// For the next call; what was there is forgotten.
  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  std::string message() const { return error_ ? error_->message : ""; }
  const GError* get() const { return error_; }

 private:
  GError* error_{nullptr};
};

}  // namespace visavis
