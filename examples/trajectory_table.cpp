// The trajectory of a scene file as CSV, as `tumble simulate --trajectory` writes it: trajectory_table SCENE.toml >
// T.csv
#include <tumble/tumble.h>

#include <cstdio>

namespace {

void print_rows(const tumble::Scene& scene, const tumble::Snapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        if (scene.body_type(i) == tumble::BodyType::fixed) continue;
        const tumble::BodyState& body = snapshot.bodies[i];
        std::printf("%lld,%.17g,%s", static_cast<long long>(snapshot.frame), snapshot.time, scene.body_name(i).c_str());
        const tumble::Vec3& x = body.center_of_mass;
        const tumble::Quat& q = body.orientation;
        const tumble::Vec3& v = body.velocity;
        const tumble::Vec3& w = body.angular_velocity;
        for (const double number : {x.x, x.y, x.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z})
            std::printf(",%.17g", number);
        std::printf("\n");
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: trajectory_table SCENE.toml\n");
        return 2;
    }
    try {
        const tumble::Scene scene = tumble::load_scene(argv[1]);
        tumble::World world(scene);
        std::printf("frame,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n");
        for (std::int64_t frame = 0; frame < scene.frame_count(); ++frame) {
            if (frame > 0) world.advance_frame();
            print_rows(scene, world.snapshot());
        }
    } catch (const tumble::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.kind() == tumble::ErrorKind::input ? 2 : 1;
    }
}
