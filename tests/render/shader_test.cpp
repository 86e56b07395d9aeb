// Shader files: found, assembled, and named in errors.
#include "drawing.h"
#include "example_scenes.h"

#include "core/error.h"
#include "render/gl/shader_source.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

namespace tumble::shader_test {
namespace {

std::string failure(const RenderOptions& options) {
    SceneDescription scene = empty_scene();
    scene.bodies = {box_body(Vec3::Zero(), Vec3::Ones(), {200, 200, 200})};
    try {
        Renderer renderer(scene, options);
    } catch (const RunError& error) {
        return error.what();
    }
    return "";
}

TEST(Shaders, ABrokenOneIsNamedWithItsLine) {
    ShaderCopy shaders;
    const int line = shaders.replace("box.frag", "vec2 on_face = clamp(v_on_face,", "vec2 on_face = clamp(nonsense,");
    const std::string message = failure(shaders.options());
    EXPECT_NE(message.find((shaders.folder() / "box.frag").string() + ":" + std::to_string(line)), std::string::npos)
        << message;
    EXPECT_NE(message.find("nonsense"), std::string::npos) << message;
}

TEST(Shaders, ABrokenIncludedFileIsNamedToo) {
    ShaderCopy shaders;
    const int line = shaders.replace("lighting.glsl", "float a2 = a * a;", "float a2 = missing_name;");
    const std::string message = failure(shaders.options());
    EXPECT_NE(message.find("lighting.glsl:" + std::to_string(line)), std::string::npos) << message;
}

TEST(Shaders, AMissingOneIsNamedWithTheIncludingFile) {
    ShaderCopy shaders;
    shaders.remove("shadow.glsl");
    const std::string message = failure(shaders.options());
    EXPECT_NE(message.find("shadow.glsl"), std::string::npos) << message;
    EXPECT_NE(message.find("lighting.glsl"), std::string::npos) << message;
}

TEST(Shaders, AMissingFolderIsNamed) {
    const std::string message = failure({GlBackend::osmesa, "/nowhere/at/all"});
    EXPECT_NE(message.find("/nowhere/at/all"), std::string::npos) << message;
}

TEST(Shaders, AreFoundInTheSourceTreeOrWhereTheVariableSays) {
    unsetenv("TUMBLE_SHADERS");
    EXPECT_TRUE(std::filesystem::exists(find_shader_folder() / "light_constants.glsl"));
    ShaderCopy shaders;
    setenv("TUMBLE_SHADERS", shaders.folder().c_str(), 1);
    EXPECT_EQ(find_shader_folder(), shaders.folder());
    setenv("TUMBLE_SHADERS", "/nowhere/at/all", 1);
    try {
        find_shader_folder();
        ADD_FAILURE() << "a folder that is not there was accepted";
    } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos);
    }
    unsetenv("TUMBLE_SHADERS");
}

TEST(Shaders, DefinesComeAfterTheVersionAndFilesOnce) {
    ShaderCopy shaders;
    const ShaderSource source = read_shader(shaders.folder(), "box.frag", {"NUMBER 5"});
    EXPECT_EQ(source.text.rfind("#version", 0), 0u);
    EXPECT_EQ(source.text.find("#define NUMBER 5"), source.text.find('\n') + 1);
    std::size_t times = 0;
    for (std::size_t at = source.text.find("struct Surface"); at != std::string::npos;
         at = source.text.find("struct Surface", at + 1))
        ++times;
    EXPECT_EQ(times, 1u);
    EXPECT_EQ(source.with_file_names("0:3(3): error: x\n"), source.files[1].string() + ":1(3): error: x\n");
    EXPECT_EQ(source.with_file_names("note 0:7\n"), "note 0:7\n");
}

// llvmpipe reads a uniform of a fragment shader lane by lane, with forty instructions each.
TEST(Shaders, FragmentsReadNoUniforms) {
    int fragments = 0;
    for (const auto& entry : std::filesystem::directory_iterator(find_shader_folder())) {
        if (entry.path().extension() != ".frag") continue;
        ++fragments;
        std::istringstream lines(read_shader(find_shader_folder(), entry.path().filename().string()).text);
        for (std::string line; std::getline(lines, line);) {
            const bool reads = line.starts_with("uniform") || line.find(") uniform") != std::string::npos;
            EXPECT_FALSE(reads && line.find("sampler") == std::string::npos) << entry.path() << ": " << line;
        }
    }
    EXPECT_GE(fragments, 5);
}

}  // namespace
}  // namespace tumble::shader_test
