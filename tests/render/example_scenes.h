// Scenes built in code for the tests of drawing: no file is read and nothing is simulated.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

namespace tumble {

/// A small empty scene: 320 x 180 pixels, the default light, an eye at (0, 1, 8) looking at (0, 1, 0).
SceneDescription empty_scene();

BodyDescription ground_plane(Color color = {176, 180, 184}, Pattern pattern = Pattern::grid);
BodyDescription box_body(const Vec3& position, const Vec3& size, Color color, const Quat& rotation = Quat::Identity());
BodyDescription ball_body(const Vec3& position, double radius, Color color, const Quat& rotation = Quat::Identity());
BodyDescription mesh_body(const Vec3& position, std::shared_ptr<const MeshAsset> asset, Color color,
                          const Quat& rotation = Quat::Identity());

/// True if start + t way is inside the box for any t from 0 to end, by its slabs.
bool passes_through(const BodyDescription& box, const Vec3& start, const Vec3& way, double end);

/// A ring in the plane y = 0, around the y axis, of 2 around x across triangles.
std::shared_ptr<const MeshAsset> torus_asset(double ring_radius, double tube_radius, std::uint32_t around = 64,
                                             std::uint32_t across = 32);

/// A flat square in the plane y = 0, seen from above, of 2 cells^2 triangles.
std::shared_ptr<const MeshAsset> sheet_asset(double size, std::uint32_t cells);

/// The initial poses of the description.
Snapshot first_snapshot(const SceneDescription& scene);

/// `count` boxes of about 1 m piled on the ground, seen as in a demo clip.
SceneDescription heap_scene(int count);

/// All lengths times a factor.
SceneDescription scaled(SceneDescription scene, double factor);

/// All positions displaced.
SceneDescription moved(SceneDescription scene, const Vec3& by);

}  // namespace tumble
