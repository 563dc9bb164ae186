#include "common/rigs/rig_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"

namespace visavis {
namespace {

template <std::size_t n>
Rule<std::array<double, n>> NotNegative() {
  return {[](const std::array<double, n>& values) {
            return std::all_of(values.begin(), values.end(),
                               [](double v) { return v >= 0 && std::isfinite(v); });
          },
          "must be " + std::to_string(n) + " numbers >= 0"};
}

struct CameraFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("width", &camera.width, InRange(1, 16384, "px"));
    a->Visit("height", &camera.height, InRange(1, 16384, "px"));
    a->Visit("fx", &camera.fx, InRange(1.0, 1e6, "px"));
    a->Visit("fy", &camera.fy, InRange(1.0, 1e6, "px"));
    a->Visit("cx", &camera.cx, InRange(-16384.0, 32768.0, "px"));
    a->Visit("cy", &camera.cy, InRange(-16384.0, 32768.0, "px"));
    a->Visit("distortion", &camera.distortion);
  }
  Pinhole camera;
};

struct TransformFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("p_m", &p_m);
    a->Visit("q_wxyz", &q_wxyz);
  }
  static TransformFields Of(const RigidTransform& X) {
    const Eigen::Quaterniond q = CanonicalQuaternion(X.linear());
    const Eigen::Vector3d p = X.translation();
    return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
  }
  RigidTransform ToTransform(const std::string& key) const {
    const Eigen::Quaterniond q(q_wxyz[0], q_wxyz[1], q_wxyz[2], q_wxyz[3]);
    if (!(std::abs(q.norm() - 1) <= 1e-3)) {
      throw FieldError(key + ".q_wxyz", "norm " + std::to_string(q.norm()),
                       "must be 1 within 0.001");
    }
    const Eigen::Vector3d p(p_m[0], p_m[1], p_m[2]);
    if (!p.allFinite()) throw FieldError(key + ".p_m", "not finite", "must be three numbers in m");
    return MakeTransform(q, p);
  }
  std::array<double, 3> p_m{0, 0, 0};
  std::array<double, 4> q_wxyz{1, 0, 0, 0};
};

struct ArmFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("urdf", &urdf);
    a->Visit("base", &base);
    a->Visit("tip", &tip);
    a->Visit("X_WB", &X_WB);
  }
  std::string urdf, base, tip;
  TransformFields X_WB;
};

// Standard deviations, in the fields' own units.
struct CameraUncertaintyFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("fx", &sigma.fx, InRange(0.0, 1e6, "px"));
    a->Visit("fy", &sigma.fy, InRange(0.0, 1e6, "px"));
    a->Visit("cx", &sigma.cx, InRange(0.0, 1e6, "px"));
    a->Visit("cy", &sigma.cy, InRange(0.0, 1e6, "px"));
    a->Visit("distortion", &sigma.distortion, NotNegative<5>());
  }
  CameraUncertainty sigma;
};

struct PoseUncertaintyFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("p_m", &sigma.p_m, NotNegative<3>());
    a->Visit("r_rad", &sigma.r_rad, NotNegative<3>());
  }
  PoseUncertainty sigma;
};

struct UncertaintyFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("right", &right);
    a->Visit("left", &left);
    a->Visit("X_CL", &X_CL);
    if (has_hand_eye) a->Visit("X_HC", &X_HC);
  }
  CameraUncertaintyFields right, left;
  PoseUncertaintyFields X_CL, X_HC;
  bool has_hand_eye{true};
};

struct RigFields {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("right", &right);
    a->Visit("left", &left);
    a->Visit("X_CL", &X_CL);
    if (has_hand_eye) a->Visit("X_HC", &X_HC);
    if (has_arm) a->Visit("arm", &arm);
    if (has_uncertainty) a->Visit("uncertainty", &uncertainty);
  }
  CameraFields right, left;
  TransformFields X_CL, X_HC;
  ArmFields arm;
  UncertaintyFields uncertainty;
  bool has_hand_eye{true}, has_arm{true}, has_uncertainty{true};
};

using ReadFile = std::function<std::string(const std::string&)>;

// What has no default: these keys must stand in @p node, whose own key is @p parent.
void Require(const YAML::Node& node, const std::string& parent,
             std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (!node[key]) throw FieldError(parent + key, "missing", "must be given");
  }
}

void RequireKeys(const YAML::Node& root) {
  Require(root, "", {"right", "left", "X_CL"});
  for (const char* camera : {"right", "left"}) {
    Require(root[camera], std::string(camera) + ".", {"width", "height", "fx", "fy", "cx", "cy"});
  }
  for (const char* transform : {"X_CL", "X_HC"}) {
    if (root[transform]) Require(root[transform], std::string(transform) + ".", {"p_m", "q_wxyz"});
  }
  if (root["arm"]) Require(root["arm"], "arm.", {"urdf", "base", "tip"});
}

RigDescription FromFields(const RigFields& fields, const YAML::Node& root,
                          const ReadFile& read_file) {
  RequireKeys(root);
  RigDescription description;
  description.rig = {fields.right.camera, fields.left.camera, fields.X_CL.ToTransform("X_CL")};
  if (root["X_HC"]) description.X_HC = fields.X_HC.ToTransform("X_HC");
  if (root["arm"]) {
    std::string urdf;
    try {
      urdf = read_file(fields.arm.urdf);
    } catch (const std::runtime_error&) {
      throw FieldError("arm.urdf", fields.arm.urdf, "cannot be read");
    }
    if (urdf.empty()) throw FieldError("arm.urdf", fields.arm.urdf, "is empty");
    description.arm = ArmDescription{urdf, fields.arm.base, fields.arm.tip,
                                     fields.arm.X_WB.ToTransform("arm.X_WB")};
  }
  if (const YAML::Node node = root["uncertainty"]) {
    const UncertaintyFields& given = fields.uncertainty;
    description.uncertainty =
        RigUncertainty{given.right.sigma, given.left.sigma, given.X_CL.sigma, {}};
    if (node["X_HC"]) description.uncertainty->X_HC = given.X_HC.sigma;
  }
  const auto check = [](const char* key, const auto& validate) {
    try {
      validate();
    } catch (const std::invalid_argument& e) {
      throw FieldError(key, "contradictory", e.what());
    }
  };
  check("right", [&] { description.rig.right.ValidateOrThrow(); });
  check("left", [&] { description.rig.left.ValidateOrThrow(); });
  check("X_CL", [&] { description.rig.ValidateOrThrow(); });
  check(root["arm"] ? "arm" : "X_HC", [&] { description.ValidateOrThrow(); });
  return description;
}

RigDescription FromSource(const ConfigSource& source, const ReadFile& read_file) {
  RigFields fields;
  ConfigReader reader(source, source.root(), "");
  fields.Serialize(&reader);
  reader.RejectUnknownKeys();
  try {
    return FromFields(fields, source.root(), read_file);
  } catch (const FieldError& e) {
    throw ConfigError(source.PlaceOf(e.key()) + ": " + e.what());
  }
}

}  // namespace

RigDescription LoadRigFile(const std::string& filename) {
  const auto folder = std::filesystem::path(filename).parent_path();
  return FromSource(ConfigSource(filename, {}), [&](const std::string& name) {
    std::ifstream file(folder / name, std::ios::binary);
    if (!file || !std::filesystem::is_regular_file(folder / name)) throw std::runtime_error(name);
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  });
}

void RequireRigFile(const std::string& filename) {
  if (filename.empty()) return;
  if (!std::filesystem::is_regular_file(filename)) {
    throw FieldError("rig_file", filename, "must be a file that exists, or empty");
  }
  try {
    LoadRigFile(filename);
  } catch (const std::invalid_argument& e) {
    throw FieldError("rig_file", filename, e.what());
  }
}

RigDescription ParseRig(const std::string& text, const std::string& name,
                        const ReadFile& read_file) {
  return FromSource(ConfigSource::FromText(text, name), read_file);
}

void SaveRigFile(const RigDescription& description, const std::string& filename) {
  RigFields fields;
  fields.right.camera = description.rig.right;
  fields.left.camera = description.rig.left;
  fields.X_CL = TransformFields::Of(description.rig.X_CL);
  fields.has_hand_eye = description.X_HC.has_value();
  fields.has_arm = description.arm.has_value();
  if (description.X_HC) fields.X_HC = TransformFields::Of(*description.X_HC);
  fields.has_uncertainty = description.uncertainty.has_value();
  if (description.uncertainty) {
    const RigUncertainty& sigma = *description.uncertainty;
    fields.uncertainty.right.sigma = sigma.right;
    fields.uncertainty.left.sigma = sigma.left;
    fields.uncertainty.X_CL.sigma = sigma.X_CL;
    fields.uncertainty.has_hand_eye = sigma.X_HC.has_value();
    fields.uncertainty.X_HC.sigma = sigma.X_HC.value_or(PoseUncertainty{});
  }
  const auto write = [](const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error(path.string() + ": cannot be written");
  };
  if (description.arm) {
    const ArmDescription& arm = *description.arm;
    fields.arm = {"arm.urdf", arm.base_link, arm.tip_link, TransformFields::Of(arm.X_WB)};
    write(std::filesystem::path(filename).parent_path() / "arm.urdf", arm.urdf);
  }
  write(filename, DumpConfig(fields) + "\n");
}

}  // namespace visavis
