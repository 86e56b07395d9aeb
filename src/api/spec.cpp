#include "tumble/spec.h"

#include "api/guard.h"
#include "api/spec_text.h"

namespace tumble::v0 {

std::string to_toml(const SceneSpec& spec) {
    return guarded([&] {
        SpecText made = spec_text(spec);
        if (!made.first_mesh.empty())
            throw Error(ErrorKind::input, {{}, 0, 0, made.first_mesh},
                        "a mesh in memory cannot be part of a scene file: use a Mesh with the name of a file");
        return std::move(made.text);
    });
}

}  // namespace tumble::v0
