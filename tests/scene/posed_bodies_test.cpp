// poses = "FILE.csv": the values of the rows, the files that were read, and every refusal at file, line and column.
#include "scene/keys/posed_bodies.h"
#include "core/error.h"
#include "scene/hash/scene_hash.h"
#include "scene/keys/bodies.h"
#include "scene/load.h"
#include "scene/toml/limits.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace tumble::posed_bodies_test {
namespace {

const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "posed_bodies";

void write_rows(const std::string& text) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "poses.csv", std::ios::binary) << text;
}

std::string scene_text(const std::string& keys) {
    return "format = 1\n[[body]]\nname = \"first\"\nshape = { type = \"sphere\", radius = 2 }\n[[body]]\n"
           "shape = { type = \"box\", size = [1, 2, 3] }\nposes = \"poses.csv\"\n" +
           keys;
}

SceneDescription load(const std::string& rows, const std::string& keys = "", FileList* read = nullptr) {
    write_rows(rows);
    return parse_scene(scene_text(keys), folder / "scene.toml", {}, read);
}

std::string error_of(const std::string& rows, const std::string& keys = "") {
    try {
        load(rows, keys);
    } catch (const InputError& error) {
        std::string text = error.what();
        if (const std::size_t at = text.find(folder.string()); at == 0) text.erase(0, folder.string().size() + 1);
        return text;
    }
    return "no error";
}

TEST(PosedBodies, HaveTheValuesOfTheirRows) {
    FileList read;
    const SceneDescription scene = load(
        "vx,vy,vz,body,x,y,z,qw,qx,qy,qz,wx,wy,wz\n"
        "1,2,3,a,4,5,6,0,1,0,0,7,8,9\r\n"
        "\n"
        "0,0,0,\"b, \"\"c\"\"\",-1e-1, +2 ,.5,0.8,0,0.6,0,0,0,0",
        "mass = 3\ncolor = \"#010203\"\n", &read);
    ASSERT_EQ(scene.bodies.size(), 3u);
    const BodyDescription &a = scene.bodies[1], &b = scene.bodies[2];
    EXPECT_EQ(a.name, "a");
    EXPECT_EQ(a.position, Vec3(4, 5, 6));
    EXPECT_EQ(a.rotation.coeffs(), Quat(0, 1, 0, 0).coeffs());
    EXPECT_EQ(a.velocity, Vec3(1, 2, 3));
    EXPECT_EQ(a.angular_velocity, Vec3(7, 8, 9));
    EXPECT_EQ(b.name, "b, \"c\"");
    EXPECT_EQ(b.position, Vec3(-0.1, 2, 0.5));
    EXPECT_NEAR(b.rotation.y(), 0.6, 1e-15);
    for (const BodyDescription* one : {&a, &b}) {
        EXPECT_EQ(std::get<BoxShape>(one->shape).size, Vec3(1, 2, 3));
        EXPECT_EQ(one->mass, 3.0);
        EXPECT_EQ(one->appearance.color.b, 3);
    }
    EXPECT_EQ(read, (FileList{folder / "scene.toml", folder / "poses.csv"}));
}

TEST(PosedBodies, AreTheSameSceneAsTheirTables) {
    const SceneDescription posed = load("x,y,z\n0,1,2\n3,4,5\n", "name = \"box\"\nvelocity = [1, 0, 0]\n");
    std::string text = "format = 1\n[[body]]\nname = \"first\"\nshape = { type = \"sphere\", radius = 2 }\n";
    for (const char* rest : {"name = \"box.0\"\nposition = [0, 1, 2]\n", "name = \"box.1\"\nposition = [3, 4, 5]\n"})
        text += std::string("[[body]]\nshape = { type = \"box\", size = [1, 2, 3] }\nvelocity = [1, 0, 0]\n") + rest;
    EXPECT_EQ(scene_hash(posed), scene_hash(parse_scene(text, folder / "scene.toml")));
    EXPECT_NE(scene_hash(posed), scene_hash(load("x,y,z\n0,1,2\n3,4,6\n", "name = \"box\"\nvelocity = [1, 0, 0]\n")));
    EXPECT_EQ(load("x,y,z\n0,0,0\n").bodies[1].name, "1");  // without names: the index
}

TEST(PosedBodies, MistakesInTheFileHaveLineAndColumn) {
    struct Mistake {
        const char *rows, *error;
    };
    for (const Mistake& mistake : std::vector<Mistake>{
             {"", "poses.csv:1:1: error: is empty: the first line names the columns, such as x,y,z"},
             {"\n\n", "poses.csv:1:1: error: is empty"},
             {"x,y,z\n", "poses.csv:1:1: error: has no row"},
             {"x,y,z,vw\n", "poses.csv:1:7: error: unknown column \"vw\""},
             {"x,y,z,\n", "poses.csv:1:7: error: unknown column \"\""},
             {"x,y,x\n", "poses.csv:1:5: error: x is there twice"},
             {"body,x,z\n", "poses.csv:1:1: error: has no column \"y\": x, y, z go together"},
             {"x,y,z,vx,vy\n", "poses.csv:1:1: error: has no column \"vz\": vx, vy, vz go together"},
             {"x,y,z,qy\n", "poses.csv:1:1: error: has no column \"qw\": qw, qx, qy, qz go together"},
             {"x,y,z\n1,2,3\n\n1,2\n", "poses.csv:4:1: error: must have a cell for each column: 3 (given 2)"},
             {"x,y,z\n1,2,3,4\n", "poses.csv:2:1: error: must have a cell for each column: 3 (given 4)"},
             {"x,y,z\n1,,3\n", "poses.csv:2:3: error: y must be a number (given \"\")"},
             {"x,y,z\n1,2,0x3\n", "poses.csv:2:5: error: z must be a number (given \"0x3\")"},
             {"x,y,z\n1,+-2,3\n", "poses.csv:2:3: error: y must be a number"},
             {"x,y,z\n1,nan,3\n", "poses.csv:2:3: error: y must be a finite number (given"},
             {"x,y,z\n1,2,1e400\n", "poses.csv:2:5: error: z must be a number"},
             {"body,x,y,z\n\xC3\xA9,2,2e9,3\n", "poses.csv:2:5: error: y must be from"},
             {"body,x,y,z\n\xC3,2,2,3\n", "poses.csv:2:1: error: body must be printable UTF-8 (given \"\\xc3\")"},
             {"body,x,y,z\n\x1b[2J,2,2,3\n", "poses.csv:2:1: error: body must be printable UTF-8"},
             {"body,x,y,z\n\"\",2,2,3\n", "poses.csv:2:1: error: body must not be empty"},
             {"body,x,y,z\na,2,2,3\na,1,1,1\n", "poses.csv:3:1: error: body must be unique"},
             {"x,body,y,z\n2,\"a\"b,2,3\n", "poses.csv:2:6: error: a cell in quotes ends before a comma"},
             {"x,body,y,z\n2,\"a,2,3\n", "poses.csv:2:3: error: the quote at the start of this cell has no end"},
             {"x,y,z,qw,qx,qy,qz\n1,2,3,1,1,0,0\n", "poses.csv:2:7: error: qw must begin a quaternion of length 1"},
             {"x,y,z,vx,vy,vz\n1,2,3,1,2e9,0\n",
              "poses.csv:2:9: error: vy must be from -1000000000 to 1000000000 m/s"}})
        EXPECT_EQ(error_of(mistake.rows).substr(0, std::string(mistake.error).size()), mistake.error) << mistake.rows;
}

TEST(PosedBodies, MistakesInTheTableHaveItsLine) {
    const std::string rows = "body,x,y,z,vx,vy,vz,wx,wy,wz,qw,qx,qy,qz\na,0,0,0,0,0,0,0,0,0,1,0,0,0\n";
    for (const char* key : {"name = \"box\"", "position = [0, 0, 0]", "velocity = [0, 0, 0]",
                            "angular_velocity = [0, 0, 0]", "rotation = [1, 0, 0, 0]",
                            "grid = { count = [1, 1, 1], spacing = 1 }", "scatter = { count = 1, size = [9, 9, 9] }"}) {
        const std::string error = error_of(rows, std::string(key) + "\n");
        EXPECT_EQ(error.substr(0, 13), "scene.toml:8:") << key << error;
        EXPECT_NE(error.find("exclude each other: give one of them"), std::string::npos) << key << error;
    }
    EXPECT_NE(error_of("x,y,z\n0,0,0\n", "scale = [1, 2]\n").find("needs a grid or a scatter"), std::string::npos);
    EXPECT_NE(error_of("x,y,z\n0,0,0\n", "type = \"kinematic\"\n").find("(given a kinematic one)"), std::string::npos);
    EXPECT_EQ(error_of(rows, "type = \"fixed\"\n"),
              "poses.csv:1:12: error: vx is for dynamic bodies: leave the column out");
    EXPECT_EQ(load("x,y,z\n0,0,0\n", "type = \"fixed\"\n").bodies[1].type, BodyType::fixed);
    for (const char* name : {"", "none.csv", ".", "/dev/null"}) {
        write_rows("x,y,z\n0,0,0\n");
        const std::string text =
            "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 2 }\nposes = \"" + std::string(name) + "\"\n";
        try {
            parse_scene(text, folder / "scene.toml");
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_EQ(error.where().line, 4) << name;
        }
    }
    EXPECT_NE(
        error_of("x,y,z\n0,0,0\n", "[[body]]\nshape = { type = \"plane\" }\ntype = \"fixed\"\nposes = \"poses.csv\"\n")
            .find("(given a plane, which is endless)"),
        std::string::npos);
}

TEST(PosedBodies, AreNoMoreThanASceneMayHave) {
    BodyDescription model;
    model.shape = SphereShape{1.0};
    BodyNames names({});
    const std::string rows = "x,y,z\n0,0,0\n1,1,1\n";
    EXPECT_EQ(read_posed_bodies(rows, "poses.csv", model, names, limits::bodies - 2).bodies.size(), 2u);
    try {
        read_posed_bodies(rows, "poses.csv", model, names, limits::bodies - 1);
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 45), "poses.csv:3:1: error: poses makes too many bo");
    }
}

}  // namespace
}  // namespace tumble::posed_bodies_test
