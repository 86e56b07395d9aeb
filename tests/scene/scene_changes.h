// Changes of single keys of a scene, for the test of its hash.
#pragma once

#include <string>
#include <vector>

namespace tumble {

/// A change of one key: the first place of `old_text` after the line `after` becomes `new_text`.
struct Change {
    std::string key, after, old_text, new_text;
    bool motion;  // it changes the motion too
};

/// A key of an image, of the repository.
inline std::string image_line(const std::string& key) {
    return key + " = \"" TUMBLE_SOURCE_DIR "/tests/fuzz/corpus/texture/rgb.png\"\n";
}
inline std::string texture_line() { return image_line("texture"); }

/// The key of an environment: the same image.
inline std::string image_line() { return "image = \"" TUMBLE_SOURCE_DIR "/tests/fuzz/corpus/texture/rgb.png\"\n"; }

/// Lines of a scene with bodies "ball", "table" and "cloud.0" to "cloud.2", and a change of each key of
/// joints.
extern const std::string joint_lines;
extern const std::vector<std::vector<Change>> joint_changes;

/// Changes of the keys of pictures and clips (cameras, lights, overlays, speed) in scene_hash_test.cpp.
extern const std::vector<std::vector<Change>> picture_changes;

}  // namespace tumble
