#include "services/calibrate_tool/pair_intake.h"

#include <algorithm>
#include <cmath>

#include "common/convert/image_message.h"
#include "common/convert/message_error.h"

namespace visavis {
namespace {

const image_t* Find(const images_t& message, std::int16_t type) {
  const std::size_t n = std::min(message.images.size(), message.image_types.size());
  for (std::size_t i = 0; i < n; ++i)
    if (message.image_types[i] == type) return &message.images[i];
  return nullptr;
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

PairIntake::PairIntake(const Board& board, const CollectorSettings& settings)
    : board_(board), settings_(settings), right_(board), left_(board) {}

BoardView PairIntake::See(const image_t& message, Side* side) {
  const BoardView view = side->detector.Detect(side->decoder.Decode(FromMessage(message)));
  side->edge_px = side->detector.EdgeWidth(view);
  return view;
}

ViewCollector::Verdict PairIntake::Add(const images_t& message) {
  const image_t *right = Find(message, images_t::RIGHT), *left = Find(message, images_t::LEFT);
  RequireField(right && left, "images_t.image_types", message.image_types.size(),
               "must name a left and a right image");
  const ImageSizes sizes{right->width, right->height, left->width, left->height};
  if (!collector_) {
    sizes_ = sizes;
    collector_.emplace(board_, settings_, sizes);
  }
  RequireField(sizes.width == sizes_.width && sizes.height == sizes_.height,
               "images_t.images[right]", SizeText(sizes.width, sizes.height),
               "must have the size of the first one");
  RequireField(sizes.left_width == sizes_.left_width && sizes.left_height == sizes_.left_height,
               "images_t.images[left]", SizeText(sizes.left_width, sizes.left_height),
               "must have the size of the first one");
  ++num_pairs_;
  StereoView view;
  view.utime_us = message.utime;
  view.right = See(*right, &right_);
  view.left = See(*left, &left_);
  return collector_->Offer(view, std::fmax(right_.edge_px, left_.edge_px));
}

std::string PairIntake::Summary() const {
  if (!collector_) return "no stereo pair";
  std::string text = std::to_string(collector_->views().size()) + " views kept of " +
                     std::to_string(num_pairs_) + " pairs";
  const char* separator = ": ";
  for (const auto verdict :
       {ViewCollector::Verdict::kNoBoard, ViewCollector::Verdict::kBlurred,
        ViewCollector::Verdict::kMoving, ViewCollector::Verdict::kNothingNew}) {
    if (collector_->count(verdict) == 0) continue;
    text +=
        separator + std::to_string(collector_->count(verdict)) + " " + ViewCollector::Name(verdict);
    separator = ", ";
  }
  return text;
}

}  // namespace visavis
