#include "scene/keys/joint_keys.h"

#include "scene/fields/joint_fields.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace tumble {
namespace {

std::string names_of(std::uint32_t types) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices<JointType>)
        if (types & bits_of(choice.value)) names.push_back(choice.name);
    return quoted_list(names);
}

void expect_keys_of(const TomlTable& table, JointType type, const KeyList& known) {
    for (std::size_t i = 0; i < known.keys.size(); ++i) {
        if ((known.joints[i] & bits_of(type)) || !table.has(known.keys[i])) continue;
        table.find(known.keys[i])
            ->origin()
            .fail(fmt::format("is a key of joints of another type: {} (given in a joint of type \"{}\")",
                              names_of(known.joints[i]), name_of(type)));
    }
}

}  // namespace

JointType read_joint_type(const TomlTable& table) {
    const KeyList known = list_keys<JointDescription>();
    table.expect_keys(known.keys);
    const TomlValue value = table.require("type");
    const JointType type = value.choice<JointType>(choices<JointType>);
    expect_keys_of(table, type, known);
    return type;
}

}  // namespace tumble
