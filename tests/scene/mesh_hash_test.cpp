// Meshes in the hash of a scene: by their content, not by their file.
#include "scene/hash/scene_hash.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace tumble::mesh_hash_test {
namespace {

SceneDescription with_mesh(const std::shared_ptr<const MeshAsset>& first,
                           const std::shared_ptr<const MeshAsset>& second) {
    SceneDescription scene;
    for (const auto& asset : {first, second}) {
        BodyDescription body;
        body.shape = MeshShape{asset};
        scene.bodies.push_back(body);
    }
    return scene;
}

TEST(MeshHash, AMeshCountsByItsContent) {
    MeshAsset asset;
    asset.file = "a.obj";
    asset.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    asset.mesh.triangles = {{0, 1, 2}};
    asset.vertices = {{{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}}};
    asset.indices = {0, 1, 2};
    MeshAsset moved = asset;
    moved.file = "b.obj";
    const auto one = std::make_shared<const MeshAsset>(asset), renamed = std::make_shared<const MeshAsset>(moved);
    const std::string hash = scene_hash(with_mesh(one, one));
    EXPECT_EQ(scene_hash(with_mesh(one, renamed)), hash);

    const auto differs = [&](const auto& change) {
        MeshAsset other = asset;
        change(other);
        return scene_hash(with_mesh(one, std::make_shared<const MeshAsset>(other))) != hash;
    };
    EXPECT_TRUE(differs([](MeshAsset& a) { a.mesh.vertices[2].z() = 1e-300; }));
    EXPECT_TRUE(differs([](MeshAsset& a) { a.mesh.triangles[0] = {0, 2, 1}; }));
    EXPECT_TRUE(differs([](MeshAsset& a) { a.vertices[1].position[1] = 1e-30f; }));
    EXPECT_TRUE(differs([](MeshAsset& a) { a.vertices[1].normal[2] = -1.0f; }));
    EXPECT_TRUE(differs([](MeshAsset& a) { a.indices = {0, 2, 1}; }));
}

}  // namespace
}  // namespace tumble::mesh_hash_test
