// Learns what is known of a head before it is seen. Usage: train_head LIST MODEL OFFSETS
//
// LIST: a line for each recording, LOG SOURCE: who it shows, a mesh file (.obj) or a procedural
// subject. MODEL: written as adult_head.dat. OFFSETS: written, a line for each head: SOURCE y z nod
// [mm, mm, deg], where in its own frame T the model's frame M lies. Mesh files and procedural heads
// count alike, however many there are of each. Prints how far the model is from the one that the
// program was built with. scripts/train-head makes the list.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/recogniser/refined/adult_head.h"
#include "tests/people/head_alignment.h"
#include "tests/people/head_scan.h"
#include "tests/people/looks_sampler.h"
#include "tests/people/looks_training.h"
#include "tests/people/model_comparison.h"
#include "tests/people/shape_training.h"
#include "tests/people/trained_head.h"

namespace visavis {
namespace {

/// Who is trained on, and what shows him or her.
struct Head {
  std::string source;
  std::vector<std::string> logs;
  std::unique_ptr<HeadScan> scan;
  double weight{0};
};

std::vector<Head> ReadList(const std::string& filename) {
  std::ifstream file(filename);
  if (!file) throw std::runtime_error(filename + ": can't be read");
  std::vector<Head> heads;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line);
    std::string log, source;
    if (!(words >> log >> source))
      throw std::runtime_error(filename + ":" + std::to_string(number) + ": must be LOG SOURCE");
    const auto same = [&](const Head& head) { return head.source == source; };
    auto head = std::find_if(heads.begin(), heads.end(), same);
    if (head == heads.end()) head = heads.insert(heads.end(), Head{source, {}, nullptr, 0});
    head->logs.push_back(log);
  }
  if (heads.empty()) throw std::runtime_error(filename + ": names no recording");
  return heads;
}

/// Loads the heads; each family has half of the weight.
void Scan(std::vector<Head>* heads) {
  std::array<int, 2> counts{};
  for (Head& head : *heads) {
    head.scan = std::make_unique<HeadScan>(head.source);
    ++counts[head.scan->is_procedural()];
  }
  const double families = (counts[0] > 0) + (counts[1] > 0);
  for (Head& head : *heads) head.weight = 1 / (families * counts[head.scan->is_procedural()]);
}

std::vector<AlignedHead> Align(const std::vector<Head>& heads) {
  const FaceRegion face = FaceRegionOf(
      [](const Eigen::Vector3f& direction) { return TheAdult().surface.Radius(direction); });
  std::vector<HeadToAlign> to_align;
  for (const Head& head : heads) {
    const HeadScan* scan = head.scan.get();
    to_align.push_back({[scan](const RigidTransform& X_TM, const Eigen::Vector3f& direction) {
                          return scan->BareRadius(X_TM, direction);
                        },
                        scan->X_TM_by_eyes(), head.weight});
  }
  AlignHeads(face, &to_align);
  std::vector<AlignedHead> aligned;
  for (std::size_t i = 0; i < heads.size(); ++i)
    aligned.push_back({heads[i].scan.get(), to_align[i].X_TM, heads[i].weight});
  return aligned;
}

void WriteOffsets(const std::string& filename, const std::vector<Head>& heads,
                  const std::vector<AlignedHead>& aligned) {
  std::ofstream file(filename);
  file << std::fixed << std::setprecision(3);
  for (std::size_t i = 0; i < heads.size(); ++i) {
    const Eigen::Vector3d p_TM = aligned[i].X_TM.translation();
    const double nod = LogRotation(aligned[i].X_TM.linear()).x();
    file << heads[i].source << ' ' << 1e3 * p_TM.y() << ' ' << 1e3 * p_TM.z() << ' '
         << 180 / M_PI * nod << '\n';
  }
  if (!file.flush()) throw std::runtime_error(filename + ": can't be written");
}

LooksModel Look(const std::vector<Head>& heads, const std::vector<AlignedHead>& aligned,
                const HeadTable& mean) {
  const LooksGrid grid;
  const LooksSampler sampler(grid, HeadSurface(HeadShape{}, mean));
  std::vector<RecordedLooks> recordings;
  for (std::size_t i = 0; i < heads.size(); ++i) {
    for (const std::string& log : heads[i].logs) {
      recordings.push_back({sampler.Sample(log, aligned[i].X_TM),
                            heads[i].weight / static_cast<double>(heads[i].logs.size())});
    }
  }
  return TrainLooks(grid, recordings, sampler.on_face());
}

void Train(const std::string& list, const std::string& model, const std::string& offsets) {
  std::vector<Head> heads = ReadList(list);
  Scan(&heads);
  std::cout << heads.size() << " heads scanned" << std::endl;
  const std::vector<AlignedHead> aligned = Align(heads);
  WriteOffsets(offsets, heads, aligned);
  std::cout << "aligned" << std::endl;
  TrainedHead trained;
  trained.shape = TrainShape(aligned);
  trained.looks = Look(heads, aligned, trained.shape.table);
  std::ofstream file(model);
  WriteHead(trained, &file);
  if (!file.flush()) throw std::runtime_error(model + ": can't be written");
  PrintComparison(trained, &std::cout);
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  if (argc != 4) {
    std::fputs("usage: train_head LIST MODEL OFFSETS\n", stderr);
    return 2;
  }
  try {
    visavis::Train(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "train_head: %s\n", e.what());
    return 1;
  }
}
