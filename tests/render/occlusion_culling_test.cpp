// Culled bodies are really hidden: checked by rays.
#include "example_scenes.h"

#include "render/culling/occlusion_culling.h"
#include "render/damage/plane_damage.h"
#include "render/render_scene_builder.h"
#include "render/scene/plane_patch.h"

#include <gtest/gtest.h>

namespace tumble::occlusion_culling_test {
namespace {

// True if the segment from the eye to `point` passes through the box well before its end.
bool blocks(const BodyDescription& box, const Vec3& eye, const Vec3& point) {
    return passes_through(box, eye, point - eye, 1.0 - 1e-6);
}

struct Heap {
    SceneDescription scene = heap_scene(150);
    RenderScene render_scene = make_render_scene(scene);
    Snapshot snapshot = first_snapshot(scene);
    FrameSetup setup{scene, render_scene};
    FrameContext frame = setup.prepare(snapshot, false);
    const Camera& view = frame.camera;
    Visibility visibility = find_visible(frame);

    bool in_picture(const Vec3& point) const {
        const Vec3 p = view.relative(point);
        const Eigen::Vector2d at = view.pixel(p);
        return p.dot(view.forward()) > 0.0 && at.x() >= 0.0 && at.y() >= 0.0 && at.x() < 1280.0 && at.y() < 720.0;
    }
    bool hidden(const Vec3& point, std::size_t except) const {
        for (std::size_t i = 1; i < scene.bodies.size(); ++i)
            if (i != except && blocks(scene.bodies[i], scene.camera.eye, point)) return true;
        return false;
    }
};

TEST(OcclusionCulling, CulledFacesAreHiddenOrTurnedAway) {
    const Heap heap;
    int left_out = 0, checked = 0;
    for (std::size_t i = 1; i < heap.scene.bodies.size(); ++i) {
        const BodyDescription& box = heap.scene.bodies[i];
        const Vec3 half = 0.5 * std::get<BoxShape>(box.shape).size;
        for (int face = 0; face < 6; ++face) {
            if ((heap.visibility.faces[i] >> face & 1) != 0) continue;
            const int axis = face / 2;
            const Vec3 normal = Vec3::Unit(axis) * (face % 2 == 0 ? -1.0 : 1.0);
            const Vec3 middle = box.position + box.rotation * normal.cwiseProduct(half);
            if ((box.rotation * normal).dot(middle - heap.scene.camera.eye) >= 0.0) continue;  // turned away
            ++left_out;
            for (double s = -0.95; s < 1.0; s += 0.19)
                for (double t = -0.95; t < 1.0; t += 0.19) {
                    Vec3 local = normal;
                    local[(axis + 1) % 3] = s;
                    local[(axis + 2) % 3] = t;
                    const Vec3 point = box.position + box.rotation * local.cwiseProduct(half);
                    if (!heap.in_picture(point)) continue;
                    ++checked;
                    EXPECT_TRUE(heap.hidden(point, i)) << "face " << face << " of body " << i;
                }
        }
    }
    EXPECT_GT(left_out, 20) << "the test must have something to check";
    EXPECT_GT(checked, 1000);
}

TEST(OcclusionCulling, OmittedPlaneRegionsAreHiddenOrUntouchedAndOthersAreDrawnOnce) {
    const Heap heap;
    const std::vector<PlanePatch>& planes = heap.frame.planes;
    ASSERT_EQ(planes.size(), 1u);
    AmbientOcclusion occlusion(heap.render_scene, heap.view.eye());
    occlusion.update(heap.frame, heap.visibility);
    ASSERT_EQ(occlusion.atlas().plane_tiles.size(), 1u);
    const PlaneOcclusionTile& tile = occlusion.atlas().plane_tiles[0];
    const PlaneAxes axes = plane_axes(planes[0].normal);
    // The darkest of the four texels around a place.
    const auto least_open = [&](const Vec3& point) {
        const Vec3 from_origin = point - heap.snapshot.bodies[tile.body].origin;
        const int i = int(std::floor(axes.u.dot(from_origin) / tile.cell - tile.low_a));
        const int j = int(std::floor(axes.v.dot(from_origin) / tile.cell - tile.low_b));
        int least = 255;
        for (const int x : {i, i + 1})
            for (const int y : {j, j + 1})
                if (x >= 0 && y >= 0 && x < tile.width && y < tile.height)
                    least = std::min<int>(
                        least, occlusion.atlas()
                                   .texels[std::size_t(tile.y + y) * OcclusionAtlas::width + std::size_t(tile.x + x)]);
        return least;
    };
    DirtyTiles everything(heap.view);
    everything.mark_all();
    const std::vector<Rectangle> areas =
        find_dirty_regions(planes[0], heap.frame, heap.visibility.cover, occlusion.atlas(), everything);
    std::vector<int> times(1280 * 720, 0);
    for (const Rectangle& area : areas)
        for (int y = area.y; y < area.y + area.height; ++y)
            for (int x = area.x; x < area.x + area.width; ++x) ++times[std::size_t(y * 1280 + x)];
    int left_out = 0, hidden = 0;
    for (int y = 0; y < 720; ++y)
        for (int x = 0; x < 1280; ++x) {
            const int drawn = times[std::size_t(y * 1280 + x)];
            EXPECT_LE(drawn, 1);
            if (drawn == 1 || x % 7 != 0 || y % 5 != 0) continue;
            const Vec3 ray = heap.view.ray(x + 0.5, y + 0.5);
            if (ray.y() >= 0.0) continue;
            ++left_out;
            const Vec3 point = heap.scene.camera.eye - ray * (heap.scene.camera.eye.y() / ray.y());
            if (heap.hidden(point, 0)) {
                ++hidden;
                continue;
            }
            for (std::size_t i = 1; i < heap.scene.bodies.size(); ++i) {
                const BodyDescription& box = heap.scene.bodies[i];
                EXPECT_FALSE(blocks(box, point - heap.scene.light.direction.normalized() * 100.0, point))
                    << "a shadow at " << x << ", " << y;
            }
            EXPECT_EQ(least_open(point), 255) << "occlusion at " << x << ", " << y;
        }
    EXPECT_GT(left_out, 5000);
    EXPECT_GT(hidden, 500);
    EXPECT_LT(left_out, 24000) << "of 26400: some ground is touched";
}

TEST(OcclusionCulling, ABoxAroundTheEyeHidesNothing) {
    SceneDescription scene = empty_scene();
    scene.bodies = {box_body(scene.camera.eye, Vec3(4.0, 4.0, 4.0), {1, 2, 3}),
                    box_body(Vec3(0.0, 1.0, 0.0), Vec3::Ones(), {1, 2, 3})};
    const RenderScene render_scene = make_render_scene(scene);
    FrameSetup setup(scene, render_scene);
    EXPECT_TRUE(find_visible(setup.prepare(first_snapshot(scene), false)).bodies[1]);
}

}  // namespace
}  // namespace tumble::occlusion_culling_test
