#include "render/gl/gl_functions.h"

#include "core/error.h"

#include <fmt/format.h>

namespace tumble {
namespace {

void* find_or_throw(const std::function<void*(const char*)>& find, const char* name) {
    void* address = find(name);
    if (address == nullptr) throw RunError(fmt::format("the OpenGL driver has no function {}", name));
    return address;
}

}  // namespace

GlFunctions load_gl_functions(const std::function<void*(const char*)>& find) {
    GlFunctions gl;
#define TUMBLE_GL_LOAD(type, name) gl.name = reinterpret_cast<type>(find_or_throw(find, "gl" #name));
    TUMBLE_GL_FUNCTIONS(TUMBLE_GL_LOAD)
#undef TUMBLE_GL_LOAD
    return gl;
}

}  // namespace tumble
