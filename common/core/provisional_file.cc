#include "common/core/provisional_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace visavis {

ProvisionalFile::ProvisionalFile(std::string name) : name_(std::move(name)) {}

ProvisionalFile::~ProvisionalFile() {
  if (!kept_) std::remove(provisional_name().c_str());
}

void ProvisionalFile::Keep() {
  if (std::rename(provisional_name().c_str(), name_.c_str()) != 0) {
    throw std::runtime_error(name_ + ": " + std::strerror(errno));
  }
  kept_ = true;
}

void WriteTextFile(const std::string& name, const std::string& text) {
  ProvisionalFile provisional(name);
  std::ofstream file(provisional.provisional_name(), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(name + ": " + std::strerror(errno));
  provisional.Keep();
}

}  // namespace visavis
