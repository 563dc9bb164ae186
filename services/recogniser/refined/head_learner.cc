#include "services/recogniser/refined/head_learner.h"

#include <utility>

#include "services/recogniser/refined/face_bundle.h"

namespace visavis {
namespace {

constexpr int kFirstFrame = 10;  ///< with a track, at which learning begins, if only of one view
constexpr int kFrames = 12, kFramesPerView = 1;  ///< that learning takes
constexpr double kGrowth = 1.5;                  ///< views for views at which it is begun anew
constexpr int kLongest = 150;                    ///< frames after which one view more will do
/// Of a head in its views, with what is beside its outline: they are most of what memory learning
/// takes.
constexpr double kRadius_m = 0.15;
/// Of the bundle: the first, of few views, needs the face's frame twice.
constexpr int kFirstTurns = 2, kTurns = 1, kRounds = 2;

}  // namespace

struct HeadLearner::Work {
  explicit Work(const HeadLearner& learner)
      : config(learner.config_),
        rig(learner.rig_),
        distance_m(learner.distance_m_),
        start(learner.start_) {}

  void Run() {
    const int turns = bundle ? kTurns : kFirstTurns;
    if (!bundle) {
      finder = std::make_unique<FaceFrame>(TheAdult());
      bundle = std::make_unique<HeadBundle>(config, rig, distance_m, start, colors, kBrightness);
    }
    bundle->SetColors(colors);
    for (HeadView& view : new_views) bundle->Add(std::move(view));
    new_views.clear();
    const std::size_t last = bundle->num_views() - 1;
    const RigidTransform X_CN = bundle->pose(last);
    learned.likeness = BundleFace(*finder, turns, kRounds, bundle.get()).likeness;
    learned.head = std::make_unique<PreparedHead>(config, bundle->Enrolled());
    learned.X_MN = bundle->pose(last).inverse() * X_CN;
  }

  const RefinerConfig config;
  const StereoRig rig;
  const double distance_m;
  const HeadGeometry start;
  std::array<ColorModel, 2> colors;
  std::vector<HeadView> new_views;
  std::unique_ptr<FaceFrame> finder;
  std::unique_ptr<HeadBundle> bundle;
  Learned learned;
};

HeadLearner::HeadLearner(const RefinerConfig& config, const StereoRig& rig, double distance_m,
                         const HeadGeometry& start, int most_views, Background* background)
    : config_(config),
      rig_(rig),
      distance_m_(distance_m),
      start_(start),
      pair_(rig, distance_m),
      most_views_(most_views),
      background_(background != nullptr ? background : &no_background_) {}

HeadLearner::~HeadLearner() = default;

void HeadLearner::SetDistance(double distance_m) {
  if (distance_m == distance_m_ || num_views() > 0) return;
  distance_m_ = distance_m;
  pair_ = WorkingPair(rig_, distance_m);
}

void HeadLearner::Forget() {
  work_.reset();  // what is under way keeps its own
  sides_.Forget();
  new_views_.clear();
  frames_ = learned_views_ = learned_frame_ = 0;
  begun_ = -1;
}

void HeadLearner::Add(const StereoFrame& frame, const RigidTransform& X_CM,
                      const std::array<ColorModel, 2>& colors) {
  if (begun_ >= 0 || num_views() >= most_views_ || !sides_.Take(X_CM)) return;
  new_views_.push_back(ViewOf(frame, X_CM, kRadius_m, &pair_));
  colors_ = colors;
}

bool HeadLearner::IsDue() const {
  const int views = num_views();
  if (views == 0 || views == learned_views_ || frames_ < kFirstFrame) return false;
  return views >= most_views_ || views >= kGrowth * learned_views_ ||
         frames_ > learned_frame_ + kLongest;
}

HeadLearner::Learned HeadLearner::Step() {
  ++frames_;
  if (begun_ < 0) {
    if (IsDue() && background_->IsFinished()) {
      begun_ = frames_;
      if (!work_) work_ = std::make_shared<Work>(*this);
      work_->new_views = std::move(new_views_);
      new_views_.clear();
      work_->colors = colors_;
      background_->Begin([work = work_] { work->Run(); });
    }
    return {};
  }
  const int frames = kFrames + kFramesPerView * num_views();
  if (frames_ < begun_ + frames || !background_->IsFinished()) return {};
  begun_ = -1;
  learned_views_ = num_views();
  learned_frame_ = frames_;
  sides_.Unsettle();
  for (std::size_t i = 0; i < sides_.poses().size(); ++i) sides_.SetPose(i, work_->bundle->pose(i));
  Learned learned = std::move(work_->learned);
  if (learned_views_ >= most_views_) work_.reset();
  return learned;
}

}  // namespace visavis
