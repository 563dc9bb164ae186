#include "common/kinematics/urdf_check.h"

#include <tinyxml.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace visavis {
namespace {

constexpr std::size_t kMaxBytes = 4 << 20;
constexpr int kMaxNesting = 256;   // a URDF needs 6
constexpr int kMaxJoints = 1'000;  // a humanoid with hands has about 100

/// Depth of element nesting, from the tags alone; text that looks like tags may raise it.
int MaxNesting(const std::string& xml) {
  int depth = 0, max_depth = 0;
  for (std::size_t i = 0; i + 1 < xml.size(); ++i) {
    if (xml[i] == '<' && xml[i + 1] != '/' && xml[i + 1] != '!' && xml[i + 1] != '?') {
      max_depth = std::max(max_depth, ++depth);
    } else if ((xml[i] == '<' && xml[i + 1] == '/') || (xml[i] == '/' && xml[i + 1] == '>')) {
      --depth;
    }
  }
  return max_depth;
}

std::string Attribute(const TiXmlElement* element, const char* name) {
  const char* value = element ? element->Attribute(name) : nullptr;
  return value ? value : "";
}

struct Joint {
  std::string name, parent;
};

/// Joints by child link.
std::map<std::string, Joint> ReadJoints(const TiXmlElement& robot) {
  std::map<std::string, Joint> joints;
  for (const TiXmlElement* e = robot.FirstChildElement("joint"); e;
       e = e->NextSiblingElement("joint")) {
    const std::string child = Attribute(e->FirstChildElement("child"), "link");
    const Joint joint{Attribute(e, "name"), Attribute(e->FirstChildElement("parent"), "link")};
    const auto [entry, is_new] = joints.emplace(child, joint);
    if (!is_new) {
      RefuseArm("link " + Quoted(child) + " is the child of joints " + Quoted(entry->second.name) +
                " and " + Quoted(joint.name) + ", must have one parent");
    }
    if (joints.size() > kMaxJoints) {
      RefuseArm("URDF has more than " + std::to_string(kMaxJoints) + " joints, must have fewer");
    }
  }
  return joints;
}

void CheckNoCycle(const std::map<std::string, Joint>& joints) {
  for (const auto& [first, unused] : joints) {
    std::set<std::string> above;
    auto joint = joints.find(first);
    while (joint != joints.end()) {
      if (!above.insert(joint->first).second) {
        RefuseArm("links above " + Quoted(first) + " form a cycle, must form a tree");
      }
      joint = joints.find(joint->second.parent);
    }
  }
}

}  // namespace

std::string Printable(const std::string& text, std::size_t max_length) {
  std::string line = text.substr(0, max_length);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
  return text.size() > max_length ? line + "..." : line;
}

std::string Quoted(const std::string& name) { return "'" + Printable(name, 80) + "'"; }

void RefuseArm(const std::string& what) { throw std::invalid_argument("arm: " + what); }

void CheckUrdf(const std::string& urdf) {
  if (urdf.empty()) RefuseArm("URDF is empty, must hold a robot");
  if (urdf.size() > kMaxBytes) {
    RefuseArm("URDF has " + std::to_string(urdf.size()) + " bytes, must have at most " +
              std::to_string(kMaxBytes));
  }
  if (const int nesting = MaxNesting(urdf); nesting > kMaxNesting) {
    RefuseArm("URDF nests " + std::to_string(nesting) + " elements, must nest at most " +
              std::to_string(kMaxNesting));
  }
  TiXmlDocument document;
  document.Parse(urdf.c_str());
  if (document.Error()) {
    RefuseArm("URDF cannot be read: line " + std::to_string(document.ErrorRow()) + ": " +
              Printable(document.ErrorDesc()));
  }
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (!robot) RefuseArm("URDF cannot be read: it holds no <robot>");
  CheckNoCycle(ReadJoints(*robot));
}

}  // namespace visavis
