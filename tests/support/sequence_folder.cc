#include "tests/support/sequence_folder.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "common/image/image_decoder.h"

namespace visavis {

SequenceFolder::SequenceFolder() {
  Write("rig.yaml",
        "right: {width: 8, height: 6, fx: 10, fy: 10, cx: 3.5, cy: 2.5, distortion: [0, 0, 0, 0, "
        "0]}\n"
        "left: {width: 8, height: 6, fx: 10, fy: 10, cx: 3.5, cy: 2.5, distortion: [0.1, 0, 0, 0, "
        "0]}\n"
        "X_CL: {p_m: [-0.15, 0, 0], q_wxyz: [1, 0, 0, 0]}\n");
  Write("a_left.ppm", MakePnm(8, 6, false, 1));
  Write("a_right.ppm", MakePnm(8, 6, false, 2));
  Write("b_left.pgm", MakePnm(8, 6, true, 3));
  Write("b_right.jpg", MakeJpeg(8, 6));
  Write("frames.csv",
        "frame,time_s,left,right\n"
        "0,0.000000,a_left.ppm,a_right.ppm\n"
        "1,0.100000,a_left.ppm,a_right.ppm\n"
        "2,0.200000,b_left.pgm,b_right.jpg\n"
        "5,0.300000,b_left.pgm,b_right.jpg\n");
  Write("camera_pose.csv",
        "frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n"
        "0,0.000000,0.15,0,0,1,0,0,0\n"
        "1,0.100000,0.14,0,0,1,0,0,0\n"
        "2,0.200000,0.13,0,0,1,0,0,0\n"
        "5,0.300000,0.12,0,0,1,0,0,0\n");
  Write("truth.csv",
        "frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n"
        "0,0.000000,-0.15,0.01,1,0.8,0.6,0,0\n"
        "1,0.100000,-0.14,0.01,1,0.8,0.6,0,0\n"
        "2,0.200000,-0.13,0.01,1,0.8,0.6,0,0\n");
}

void SequenceFolder::Write(const std::string& name, const std::string& text) const {
  if (text.empty()) {
    std::filesystem::remove_all(File(name));
    return;
  }
  std::ofstream(File(name), std::ios::binary) << text;
}

std::string SequenceFolder::Read(const std::string& name) const {
  std::ifstream file(File(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void SequenceFolder::Replace(const std::string& name, const std::string& from,
                             const std::string& to) const {
  std::string text = Read(name);
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error(name + " has no '" + from + "'");
  Write(name, text.replace(at, from.size(), to));
}

std::vector<std::uint8_t> MakePixels(int width, int height, bool grey, int seed) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < width * height * (grey ? 1 : 3); ++i) {
    pixels.push_back(static_cast<std::uint8_t>(10 * seed + i));
  }
  return pixels;
}

std::string MakePnm(int width, int height, bool grey, int seed) {
  const auto pixels = MakePixels(width, height, grey, seed);
  return std::string(grey ? "P5" : "P6") + "\n" + std::to_string(width) + " " +
         std::to_string(height) + "\n255\n" + std::string(pixels.begin(), pixels.end());
}

std::string MakeJpeg(int width, int height) {
  const auto pixels = MakePixels(width, height, false, 5);
  JpegEncoder encoder;
  const ImageView jpeg = encoder.Encode(
      {pixels.data(), width, height, 3 * width, pixels.size(), PixelFormat::kRgb}, 90);
  return std::string(jpeg.data, jpeg.data + jpeg.size);
}

std::vector<LogEvent> ReadEvents(const std::string& log) {
  std::vector<LogEvent> events;
  EventLogReader reader(log);
  LogEvent event;
  while (reader.Next(&event)) events.push_back(event);
  if (reader.num_damaged_bytes() > 0) throw std::runtime_error(log + " is damaged");
  return events;
}

}  // namespace visavis
