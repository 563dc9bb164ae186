#include "services/calibrate_tool/recorded_views.h"

#include <algorithm>
#include <ostream>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/convert/rig_message.h"
#include "common/core/clock.h"
#include "common/recording/log_contents.h"

namespace visavis {
namespace {

constexpr int kLiveStates = 300'000;  // five minutes of a 1 kHz arm

std::optional<ArmDescription> ArmOf(const std::optional<ArmDescription>& given,
                                    const std::optional<RigDescription>& rig) {
  if (given) return given;
  return rig ? rig->arm : std::nullopt;
}

void ReadViews(const ViewSource& source, const std::optional<ArmDescription>& arm,
               const std::function<bool()>& stopped, PairIntake* intake, RecordedViews* recorded) {
  const LogContents contents = ReadLog(source.log, source.prefix, [&](const images_t& message) {
    if (stopped()) throw std::runtime_error("stopped");
    if (!intake->collector() || !intake->collector()->complete()) intake->Add(message);
  });
  recorded->rig = contents.rig;
  if (intake->num_pairs() == 0 && contents.num_rejected > 0)
    throw std::invalid_argument(source.log + ": " + contents.last_reject);
  const auto used = ArmOf(arm, contents.rig);
  if (!used) return;
  recorded->postures.emplace(*used, std::max(2, static_cast<int>(contents.arm_states.size())));
  for (const arm_state_t& state : contents.arm_states) recorded->postures->Add(state);
}

void ListenForViews(const ViewSource& source, const std::optional<ArmDescription>& arm,
                    const std::function<bool()>& stopped, PairIntake* intake,
                    RecordedViews* recorded, std::ostream& out) {
  LcmBus bus(source.lcm_url, source.prefix);
  std::string complaint;
  bus.set_reject_handler([&](const std::string& channel, const std::string& reason) {
    complaint = channel + ": " + reason;
  });
  if (arm) recorded->postures.emplace(*arm, kLiveStates);
  bus.Subscribe<stereo_rig_t>(kStereoRigChannel, [&](const stereo_rig_t& message) {
    if (recorded->rig) return;
    recorded->rig = FromMessage(message);
    if (!recorded->postures && recorded->rig->arm)
      recorded->postures.emplace(*recorded->rig->arm, kLiveStates);
  });
  bus.Subscribe<images_t>(
      kStereoImagesChannel, [&](const images_t& message) { intake->Add(message); }, 1);
  bus.Subscribe<arm_state_t>(
      kArmStateChannel,
      [&](const arm_state_t& message) {
        if (recorded->postures) recorded->postures->Add(message);
      },
      1000);
  double since_s = MonotonicSeconds();
  while (!stopped() && !(intake->collector() && intake->collector()->complete())) {
    try {
      bus.HandleOne(50);
    } catch (const std::invalid_argument& e) {
      complaint = e.what();
    }
    if (MonotonicSeconds() - since_s < 1) continue;
    since_s = MonotonicSeconds();
    out << intake->Summary();
    if (intake->collector()) out << " | " << intake->collector()->Guide();
    if (!complaint.empty()) out << " | " << complaint;
    out << std::endl;
    complaint.clear();
  }
  // The arm state behind the last view.
  const double until_s = MonotonicSeconds() + 0.3;
  while (MonotonicSeconds() < until_s) bus.HandleOne(50);
}

}  // namespace

RecordedViews CollectViews(const Board& board, const ViewSource& source,
                           const std::optional<ArmDescription>& arm, int min_views,
                           const std::function<bool()>& stopped, std::ostream& out) {
  PairIntake intake(board, source.collector);
  RecordedViews recorded;
  if (source.log.empty()) {
    ListenForViews(source, arm, stopped, &intake, &recorded, out);
  } else {
    ReadViews(source, arm, stopped, &intake, &recorded);
  }
  recorded.summary = intake.Summary();
  const std::string place = source.log.empty() ? "live" : source.log;
  if (!intake.collector()) {
    throw std::invalid_argument(place + ": " + source.prefix + kStereoImagesChannel +
                                ": missing: must hold stereo pairs");
  }
  recorded.views = intake.collector()->views();
  recorded.sizes = intake.sizes();
  if (static_cast<int>(recorded.views.size()) < min_views) {
    throw std::invalid_argument(place + ": " + recorded.summary + ": must be at least " +
                                std::to_string(min_views) + " views; is the board the one given?");
  }
  return recorded;
}

}  // namespace visavis
