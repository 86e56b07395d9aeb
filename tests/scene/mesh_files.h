// Mesh files written by the tests, each in a temporary folder.
#pragma once

#include "support/folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace tumble {

class MeshFiles : public ::testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        write_text(folder_ / name, text);
        return folder_ / name;
    }
    const std::filesystem::path& folder() const { return folder_.path(); }

    /// A cube of edge 2 about the origin, in OBJ, with separate faces so that tests can omit some.
    static std::string cube_points() {
        return "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
    }
    static std::string cube_faces() { return "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"; }

private:
    TestFolder folder_;
};

inline std::filesystem::path asset(const std::string& name) {
    return std::filesystem::path(TUMBLE_SOURCE_DIR) / "assets" / "meshes" / name;
}

}  // namespace tumble
