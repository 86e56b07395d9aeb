// Parts of a run other than numbers over time: bodies, cords, meshes, light, camera and overlays.
#pragma once

#include "page/array_store.h"
#include "page/page_run.h"

#include <map>
#include <utility>
#include <vector>

namespace tumble {

/// The meshes and the textures of shapes of all runs, each once.
class MeshTable {
public:
    /// `paint`: the colors that it is drawn with; null: the body's.
    std::size_t index_of(const MeshAsset& asset, const MeshPaint* paint);
    std::size_t index_of(const Texture& texture);
    ArrayStore::Json write(ArrayStore& arrays) const;
    ArrayStore::Json write_textures(ArrayStore& arrays) const;

private:
    using Entry = std::pair<const MeshAsset*, const MeshPaint*>;
    std::vector<Entry> meshes_;
    std::vector<const Texture*> textures_;
    std::map<Entry, std::size_t> index_;  // only looked up: their order has no effect
};

ArrayStore::Json make_bodies(const PageRun& run, MeshTable& meshes);
ArrayStore::Json make_light(const PageRun& run);
ArrayStore::Json make_cords(const PageRun& run);
ArrayStore::Json make_camera(const PageRun& run, ArrayStore& arrays);
ArrayStore::Json make_overlays(const PageRun& run);
/// Precondition: the scene has water.
ArrayStore::Json make_water(const SceneDescription& scene);

/// Three numbers.
ArrayStore::Json vector_json(const Vec3& v);

}  // namespace tumble
