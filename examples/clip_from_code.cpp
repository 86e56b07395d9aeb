// A scene that is built in code, as a clip: clip_from_code [CLIP.mp4]
#include <tumble/tumble.h>

#include <cstdio>

namespace {

tumble::SceneSpec falling_tower() {
    tumble::SceneSpec spec;
    spec.title = "A ball against a tower";
    spec.simulation.duration = 2.0;
    spec.output.width = 320;
    spec.output.height = 180;
    spec.output.fps = 30.0;

    tumble::Material wood;
    wood.color = tumble::Color{200, 133, 60};
    wood.density = 600.0;
    wood.restitution = 0.1;
    wood.friction = 0.6;

    tumble::Body& ground = spec.add(tumble::Plane{}, tumble::BodyType::fixed);
    ground.material.friction = 0.6;

    for (int i = 0; i < 5; ++i) {
        tumble::Body& crate = spec.add(tumble::Box{{1.0, 1.0, 1.0}});
        crate.material = wood;
        crate.position = {0.0, 0.5 + i, 0.0};
        crate.rotation = tumble::AxisAngle{{0.0, 1.0, 0.0}, 5.0 * i};
    }

    tumble::Body& ball = spec.add(tumble::Sphere{0.4});
    ball.name = "ball";
    ball.mass = 400.0;
    ball.position = {-6.0, 3.0, 0.0};
    ball.velocity = {9.0, 2.0, 0.0};
    return spec;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const tumble::Scene scene(falling_tower());
        tumble::World world(scene);
        tumble::Renderer renderer(scene);
        tumble::ClipWriter clip(argc > 1 ? argv[1] : "tower.mp4", scene.output());
        for (std::int64_t frame = 0; frame < scene.frame_count(); ++frame) {
            if (frame > 0) world.advance_frame();
            clip.write(renderer.render(world.snapshot()));
        }
        clip.finish();
    } catch (const tumble::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.kind() == tumble::ErrorKind::input ? 2 : 1;
    }
}
