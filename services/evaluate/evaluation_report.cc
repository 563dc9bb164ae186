#include "services/evaluate/evaluation_report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace visavis {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3;
constexpr double kDegrees = 180 / M_PI;

Json OrNull(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json ToJson(const std::optional<Statistics>& s, double unit) {
  const auto value = [&](double Statistics::*member) {
    return s ? OrNull((*s).*member * unit) : Json(nullptr);
  };
  return {{"rmse", value(&Statistics::rmse)},
          {"mean", value(&Statistics::mean)},
          {"max", value(&Statistics::max)},
          {"bias", value(&Statistics::bias)}};
}

Json ToJson(const Accuracy& accuracy) {
  const ErrorStatistics& e = accuracy.errors;
  Json json;
  json["position_mm"] = {{"x", ToJson(e.position_m[0], kMillimetres)},
                         {"y", ToJson(e.position_m[1], kMillimetres)},
                         {"z", ToJson(e.position_m[2], kMillimetres)},
                         {"norm", ToJson(e.position_norm_m, kMillimetres)}};
  json["angle_deg"] = {{"phi", ToJson(e.angle_rad[0], kDegrees)},
                       {"theta", ToJson(e.angle_rad[1], kDegrees)},
                       {"psi", ToJson(e.angle_rad[2], kDegrees)},
                       {"total", ToJson(e.total_angle_rad, kDegrees)}};
  json["share_within_15mm_5deg"] = OrNull(accuracy.share_within);
  json["share_false_tracking"] = OrNull(accuracy.share_false_tracking);
  return json;
}

Json ToJson(const HeadOffset& offset) {
  const Eigen::Quaterniond q = CanonicalQuaternion(offset.X_TM.linear());
  const Eigen::Vector3d p = offset.X_TM.translation();
  return {{"p_m", {p.x(), p.y(), p.z()}},
          {"q_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"source", offset.source}};
}

std::optional<double> Max(const std::vector<double>& values) { return Quantile(values, 1); }

/// Lines of text, printf by printf.
class Text {
 public:
  template <typename... Values>
  void Line(const char* format, Values... values) {
    const int size = std::snprintf(nullptr, 0, format, values...);
    std::string line(static_cast<std::size_t>(size) + 1, '\0');
    std::snprintf(line.data(), line.size(), format, values...);
    line.back() = '\n';
    text_ += line;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string Percent(const std::optional<double>& share) {
  if (!share) return "unknown";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * *share);
  return text;
}

std::string Value(const std::optional<double>& value, const char* format) {
  if (!value) return "unknown";
  char text[32];
  std::snprintf(text, sizeof text, format, *value);
  return text;
}

void AddAccuracy(const char* title, const Accuracy& accuracy, Text* text) {
  if (accuracy.num_frames > 0) {
    text->Line("%-14s %10s %10s %10s %10s", title, "rmse", "mean", "max", "bias");
  } else {
    text->Line("%s", title);
  }
  const auto row = [&](const char* name, const std::optional<Statistics>& s, double unit) {
    text->Line("  %-12s %10.2f %10.2f %10.2f %10.2f", name, s->rmse * unit, s->mean * unit,
               s->max * unit, s->bias * unit);
  };
  const ErrorStatistics& e = accuracy.errors;
  if (accuracy.num_frames > 0) {
    row("x mm", e.position_m[0], kMillimetres);
    row("y mm", e.position_m[1], kMillimetres);
    row("z mm", e.position_m[2], kMillimetres);
    row("distance mm", e.position_norm_m, kMillimetres);
    row("Phi deg", e.angle_rad[0], kDegrees);
    row("theta deg", e.angle_rad[1], kDegrees);
    row("psi deg", e.angle_rad[2], kDegrees);
    row("angle deg", e.total_angle_rad, kDegrees);
  }
  text->Line("  within 15 mm and 5 deg: %s, false TRACKING: %s of the frames",
             Percent(accuracy.share_within).c_str(),
             Percent(accuracy.share_false_tracking).c_str());
}

void AddOffset(const HeadOffset& offset, Text* text) {
  const Eigen::Vector3d p = kMillimetres * offset.X_TM.translation();
  const Eigen::Vector3d a = kDegrees * AnglesFromRotation(offset.X_TM.linear());
  text->Line("head offset (the model's frame in the truth's), from %s:", offset.source.c_str());
  text->Line("  %.1f %.1f %.1f mm, Phi theta psi %.2f %.2f %.2f deg", p.x(), p.y(), p.z(), a[0],
             a[1], a[2]);
}

void AddRejects(const RunRecord& record, Text* text) {
  if (record.num_rejected > 0) {
    text->Line("left out %lld messages, the last: %s", static_cast<long long>(record.num_rejected),
               record.last_reject.c_str());
  }
  if (record.num_damaged_bytes > 0) {
    text->Line("left out %lld damaged bytes", static_cast<long long>(record.num_damaged_bytes));
  }
}

}  // namespace

std::string FormatJson(const Evaluation& e) {
  Json json;
  json["schema"] = 1;
  json["frames"] = e.num_frames;
  json["frames_with_truth"] = e.num_frames_with_truth;
  json["settle_s"] = kSettle_s;
  json["share_tracking"] = OrNull(e.share_tracking);
  json["first_lock_s"] = OrNull(e.first_lock_s);
  json["recovery_frames"] = {{"count", e.recovery_frames.size()},
                             {"median", OrNull(Quantile(e.recovery_frames, 0.5))},
                             {"max", OrNull(Max(e.recovery_frames))}};
  json["raw"] = ToJson(e.raw);
  json["aligned"] = e.aligned ? ToJson(*e.aligned) : Json(nullptr);
  json["latency_ms"] = {{"p50", OrNull(Quantile(e.latencies_ms, 0.50))},
                        {"p90", OrNull(Quantile(e.latencies_ms, 0.90))},
                        {"p99", OrNull(Quantile(e.latencies_ms, 0.99))},
                        {"max", OrNull(Max(e.latencies_ms))}};
  json["head_offset"] = e.offset ? ToJson(*e.offset) : Json(nullptr);
  return json.dump(2) + "\n";
}

std::string FormatTable(const std::string& log, const RunRecord& record, const Evaluation& e) {
  Text text;
  text.Line("%s", log.c_str());
  text.Line("%lld frames, %lld with truth; %lld TRACKING, %lld SEARCHING, %lld LOST",
            static_cast<long long>(e.num_frames), static_cast<long long>(e.num_frames_with_truth),
            static_cast<long long>(e.num_by_status[1]), static_cast<long long>(e.num_by_status[0]),
            static_cast<long long>(e.num_by_status[2]));
  if (e.num_no_head > 0) {
    text.Line("no head there in %lld frames, of these TRACKING: %lld",
              static_cast<long long>(e.num_no_head),
              static_cast<long long>(e.num_tracking_no_head));
  }
  AddRejects(record, &text);
  if (e.num_frames_with_truth > 0) {
    text.Line("TRACKING in %s of the frames with truth, first lock after %s",
              Percent(e.share_tracking).c_str(), Value(e.first_lock_s, "%.3f s").c_str());
    text.Line("errors: truth minus estimate, over %lld TRACKING frames after %g s",
              static_cast<long long>(e.raw.num_frames), kSettle_s);
    AddAccuracy("raw", e.raw, &text);
    if (e.aligned) AddAccuracy("aligned", *e.aligned, &text);
  }
  if (!e.recovery_frames.empty()) {
    text.Line("%zu jumps of the truth, recovered after %s frames (median), %s at most; %lld not",
              e.recovery_frames.size(), Value(Quantile(e.recovery_frames, 0.5), "%g").c_str(),
              Value(Max(e.recovery_frames), "%g").c_str(),
              static_cast<long long>(e.num_not_recovered));
  }
  if (!e.latencies_ms.empty()) {
    text.Line("latency: %.2f ms (median), %.2f (p90), %.2f (p99), %.2f at most",
              *Quantile(e.latencies_ms, 0.5), *Quantile(e.latencies_ms, 0.9),
              *Quantile(e.latencies_ms, 0.99), *Max(e.latencies_ms));
  }
  if (e.offset) AddOffset(*e.offset, &text);
  return text.text();
}

}  // namespace visavis
