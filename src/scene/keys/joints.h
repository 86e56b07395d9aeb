// [[joint]]: joints between two bodies, or between a body and the world.
#pragma once

#include "scene/description/description.h"
#include "scene/fields/choices.h"
#include "scene/keys/body_index.h"
#include "scene/keys/joint_places.h"
#include "scene/toml/toml_reader.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tumble {

/// Names of the joints of a scene: unique, and made for joints without one.
class JointNames {
public:
    explicit JointNames(const std::vector<JointDescription>& joints);
    /// "joint N" if the table has no name. Fails at the name if it is taken.
    std::string give(const TomlTable& table, std::size_t index);
    /// Fails at the origin if the name is taken.
    void take(const std::string& name, const SourcePosition& origin);

private:
    std::set<std::string> taken_;
};

/// Appends the joints of all tables, in file order.
void read_joints(const TomlTable& root, const std::vector<BodyDescription>& bodies,
                 std::vector<JointDescription>& joints);

/// A joint of a given type, bodies and place: the keys of its table but those of its bodies and its place. Without a
/// name.
JointDescription read_placed_joint(const TomlTable& table, const JointDescription& between, const JointPlace& place,
                                   const std::vector<BodyDescription>& bodies);

/// The body of that name; empty for "world".
std::optional<std::size_t> find_side(const TomlValue& name, const BodyIndex& index);

/// The joint of that name.
const JointDescription& find_joint(const TomlValue& name, const std::vector<JointDescription>& joints);

/// Fails at the origin if a scene with so many joints has too many.
void check_number_of_joints(std::size_t number, const SourcePosition& origin);

/// The type of a joint's table. Fails at an unknown key, and at a key of another type.
JointType read_joint_type(const TomlTable& table);

}  // namespace tumble
