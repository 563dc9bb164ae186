#pragma once

#include <string>

namespace visavis {

/// An output file that appears under its name only when it is whole. Until Keep() it is NAME.part,
/// which goes at scope end.
class ProvisionalFile {
 public:
  explicit ProvisionalFile(std::string name);
  ~ProvisionalFile();
  ProvisionalFile(const ProvisionalFile&) = delete;
  ProvisionalFile& operator=(const ProvisionalFile&) = delete;

  /// Where to write.
  std::string provisional_name() const { return name_ + ".part"; }

  /// Gives the file its name, in the place of what was there.
  /// @throws std::runtime_error naming the file and the system's reason.
  void Keep();

 private:
  const std::string name_;
  bool kept_{false};
};

/// Writes a whole text file by way of a ProvisionalFile.
/// @throws std::runtime_error naming the file and the system's reason.
void WriteTextFile(const std::string& name, const std::string& text);

}  // namespace visavis
