#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace visavis {

/// One field of a message as its .lcm file declares it.
struct LcmField {
  std::string type;               ///< int32_t, string, image_t ...
  std::string name;               ///< joint_position
  std::vector<std::string> dims;  ///< "num_joints" or "3"; empty: a scalar
  std::string comment;            ///< behind the field and in comment lines below it
  int line{0};                    ///< in its file, from 1
};

/// One message as its .lcm file declares it.
struct LcmStruct {
  std::string name;
  std::string comment;  ///< above the struct
  std::vector<LcmField> fields;
};

/// Structs by name: what lcm-gen reads, read without it, so that tests have a second opinion.
using LcmSchema = std::map<std::string, LcmStruct>;

/// Reads one .lcm file in the house's form: one struct a file, one field a line.
/// @throws std::runtime_error naming file, line and rule.
LcmStruct ReadLcmFile(const std::string& file);

/// Reads every .lcm file of @p folder.
LcmSchema ReadLcmFolder(const std::string& folder);

/// Reads the project's own lcmtypes/. @throws std::runtime_error where VISAVIS_SOURCE_DIR, which
/// CTest sets, does not say where that is.
LcmSchema ReadProjectSchema();

/// Whether @p type is one of LCM's own and not a struct.
bool IsPrimitive(const std::string& type);

/// The fingerprint that LCM's documentation defines: member names, primitive types, dimensions.
std::int64_t Fingerprint(const LcmSchema& schema, const std::string& type);

/// Bytes of the shortest value of @p type on the wire, without fingerprint.
int MinEncodedSize(const LcmSchema& schema, const std::string& type);

}  // namespace visavis
