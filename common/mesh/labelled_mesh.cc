#include "common/mesh/labelled_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace visavis {
namespace {

constexpr float kFarthest_m = 1e4f;

[[noreturn]] void Refuse(const std::string& filename, const std::string& reason) {
  throw std::invalid_argument(filename + ": " + reason);
}

void ReadMaterial(const std::string& filename, const aiMaterial& material, LabelledPart* part) {
  aiString name;
  material.Get(AI_MATKEY_NAME, name);
  const std::optional<Label> label = LabelFromMaterialName(name.C_Str());
  if (!label) {
    Refuse(filename, "material '" + std::string(name.C_Str()) +
                         "': must contain skin, hair, brow, lash, eye, lip, ear, neck or cloth");
  }
  part->label = *label;
  aiColor4D colour(0.6f, 0.6f, 0.6f, 1);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  part->diffuse = {static_cast<double>(colour.r), static_cast<double>(colour.g),
                   static_cast<double>(colour.b)};
  aiString picture;
  // A name that begins with an asterisk is of a picture within the file, which is not taken.
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &picture) == aiReturn_SUCCESS &&
      picture.length > 0 && picture.C_Str()[0] != '*') {
    part->picture = std::filesystem::path(filename).parent_path() / picture.C_Str();
  }
}

void ReadTriangles(const std::string& filename, const aiMesh& from, const MeshFileOptions& options,
                   LabelledPart* part) {
  const Eigen::Vector3d axes = options.y_up ? Eigen::Vector3d(1, -1, -1) : Eigen::Vector3d::Ones();
  for (unsigned k = 0; k < from.mNumVertices; ++k) {
    const aiVector3D& p = from.mVertices[k];
    const Eigen::Vector3d scaled =
        options.scale * Eigen::Vector3d(static_cast<double>(p.x), static_cast<double>(p.y),
                                        static_cast<double>(p.z));
    part->vertices.push_back((scaled - options.p_origin_m).cwiseProduct(axes).cast<float>());
    if (!(part->vertices.back().cwiseAbs().maxCoeff() <= kFarthest_m)) {
      Refuse(filename, "mesh '" + part->name + "': vertex " + std::to_string(k) +
                           ": must have finite coordinates within 10000 m; is the scale right?");
    }
  }
  for (unsigned k = 0; from.HasTextureCoords(0) && k < from.mNumVertices; ++k) {
    const aiVector3D& t = from.mTextureCoords[0][k];
    if (!std::isfinite(t.x) || !std::isfinite(t.y)) {
      Refuse(filename, "mesh '" + part->name + "': vertex " + std::to_string(k) +
                           ": must have finite texture coordinates");
    }
    part->uv.emplace_back(t.x, 1 - t.y);
  }
  for (unsigned k = 0; k < from.mNumFaces; ++k) {
    const aiFace& face = from.mFaces[k];
    if (face.mNumIndices != 3) continue;
    for (unsigned i = 0; i < 3; ++i) {
      if (face.mIndices[i] >= from.mNumVertices) {
        Refuse(filename, "mesh '" + part->name + "': triangle " + std::to_string(k) +
                             ": must name vertices that are there");
      }
    }
    part->triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
  }
}

}  // namespace

std::vector<LabelledPart> LoadLabelledMesh(const std::string& filename,
                                           const MeshFileOptions& options) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(
      filename, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr) Refuse(filename, importer.GetErrorString());
  std::vector<LabelledPart> parts;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& from = *scene->mMeshes[i];
    if ((from.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
    LabelledPart part;
    part.name = from.mName.C_Str();
    ReadMaterial(filename, *scene->mMaterials[from.mMaterialIndex], &part);
    ReadTriangles(filename, from, options, &part);
    parts.push_back(std::move(part));
  }
  if (parts.empty()) Refuse(filename, "holds no triangles");
  return parts;
}

}  // namespace visavis
