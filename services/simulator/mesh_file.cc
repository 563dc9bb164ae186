#include "services/simulator/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <stdexcept>

#include "services/simulator/bake.h"

namespace visavis {
namespace {

[[noreturn]] void Refuse(const std::string& filename, const std::string& reason) {
  throw std::invalid_argument(filename + ": " + reason);
}

struct Material {
  Label label;
  Srgb colour;
};

Material ReadMaterial(const std::string& filename, const aiMaterial& material) {
  aiString name;
  material.Get(AI_MATKEY_NAME, name);
  const std::optional<Label> label = LabelFromMaterialName(name.C_Str());
  if (!label) {
    Refuse(filename, "material '" + std::string(name.C_Str()) +
                         "': must contain skin, hair, brow, lash, eye, lip, ear, neck or cloth");
  }
  aiColor4D colour(0.6f, 0.6f, 0.6f, 1);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  const Srgb linear(static_cast<double>(colour.r), static_cast<double>(colour.g),
                    static_cast<double>(colour.b));
  return {*label, linear.cwiseMax(0).cwiseMin(1).unaryExpr(&SrgbFromLinear)};
}

double Gloss(Label label) {
  switch (label) {
    case Label::kEye:
      return 0.5;
    case Label::kHair:
    case Label::kBrow:
    case Label::kLash:
      return 0.15;
    case Label::kClothes:
      return 0.015;
    default:
      return 0.05;
  }
}

Mesh ReadMesh(const aiMesh& from, const MeshFileOptions& options) {
  Mesh mesh;
  const Eigen::Vector3d axes = options.y_up ? Eigen::Vector3d(1, -1, -1) : Eigen::Vector3d::Ones();
  for (unsigned k = 0; k < from.mNumVertices; ++k) {
    const aiVector3D& p = from.mVertices[k];
    const Eigen::Vector3d scaled =
        options.scale * Eigen::Vector3d(static_cast<double>(p.x), static_cast<double>(p.y),
                                        static_cast<double>(p.z));
    mesh.vertices.push_back((scaled - options.p_origin_m).cwiseProduct(axes).cast<float>());
    mesh.uv.emplace_back(0.5f, 0.5f);
  }
  for (unsigned k = 0; k < from.mNumFaces; ++k) {
    const aiFace& face = from.mFaces[k];
    if (face.mNumIndices == 3) {
      mesh.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
    }
  }
  ComputeNormals(&mesh);
  return mesh;
}

}  // namespace

Figure LoadFigure(const std::string& filename, const MeshFileOptions& options) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(
      filename, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr) Refuse(filename, importer.GetErrorString());
  Figure figure;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9f), high = -low;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& from = *scene->mMeshes[i];
    if ((from.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
    const Material material = ReadMaterial(filename, *scene->mMaterials[from.mMaterialIndex]);
    Part part{from.mName.C_Str(), ReadMesh(from, options),
              UniformTexture(material.colour, Gloss(material.label), material.label)};
    try {
      part.mesh.ValidateOrThrow();
    } catch (const std::invalid_argument& e) {
      Refuse(filename, "mesh '" + part.name + "': " + e.what());
    }
    if (IsHead(material.label)) {
      for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
      }
    }
    (material.label == Label::kClothes ? figure.body : figure.head).push_back(std::move(part));
  }
  if (figure.head.empty()) Refuse(filename, "holds no triangles of a head");
  const float height = (high - low).maxCoeff();
  if (!(height >= 0.1f && height <= 1.0f)) {
    Refuse(filename, "head is " + std::to_string(height) +
                         " m large: must be 0.1 to 1 m; is the scale right?");
  }
  return figure;
}

}  // namespace visavis
