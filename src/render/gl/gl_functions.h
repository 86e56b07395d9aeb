// The OpenGL functions in use, as typed pointers loaded from one context. Passed by reference, not global, so that two
// contexts cannot be mixed up.
#pragma once

#include <GL/glcorearb.h>

#include <functional>

// (type of the pointer, name without "gl")
#define TUMBLE_GL_FUNCTIONS(X)                                                       \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                                         \
    X(PFNGLBLENDFUNCSEPARATEPROC, BlendFuncSeparate)                                 \
    X(PFNGLATTACHSHADERPROC, AttachShader)                                           \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                                               \
    X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                                       \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                                     \
    X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)                                   \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                                             \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                                     \
    X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer)                                     \
    X(PFNGLBUFFERDATAPROC, BufferData)                                               \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)                       \
    X(PFNGLCLEARPROC, Clear)                                                         \
    X(PFNGLCLEARCOLORPROC, ClearColor)                                               \
    X(PFNGLCLEARDEPTHPROC, ClearDepth)                                               \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                                         \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                                         \
    X(PFNGLCREATESHADERPROC, CreateShader)                                           \
    X(PFNGLCULLFACEPROC, CullFace)                                                   \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                         \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                               \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                                         \
    X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)                             \
    X(PFNGLDELETESHADERPROC, DeleteShader)                                           \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                                       \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                               \
    X(PFNGLDEPTHFUNCPROC, DepthFunc)                                                 \
    X(PFNGLDISABLEPROC, Disable)                                                     \
    X(PFNGLDRAWARRAYSPROC, DrawArrays)                                               \
    X(PFNGLDRAWBUFFERPROC, DrawBuffer)                                               \
    X(PFNGLDRAWELEMENTSINSTANCEDBASEINSTANCEPROC, DrawElementsInstancedBaseInstance) \
    X(PFNGLENABLEPROC, Enable)                                                       \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray)                     \
    X(PFNGLFINISHPROC, Finish)                                                       \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer)                     \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)                           \
    X(PFNGLFRONTFACEPROC, FrontFace)                                                 \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                                               \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                                     \
    X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)                                   \
    X(PFNGLGENTEXTURESPROC, GenTextures)                                             \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                                     \
    X(PFNGLGETERRORPROC, GetError)                                                   \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                                             \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                                 \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                           \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                                   \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                                             \
    X(PFNGLGETSTRINGPROC, GetString)                                                 \
    X(PFNGLGETUNIFORMBLOCKINDEXPROC, GetUniformBlockIndex)                           \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)                               \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                                             \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                                             \
    X(PFNGLREADBUFFERPROC, ReadBuffer)                                               \
    X(PFNGLPOLYGONOFFSETPROC, PolygonOffset)                                         \
    X(PFNGLREADPIXELSPROC, ReadPixels)                                               \
    X(PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC, RenderbufferStorageMultisample)       \
    X(PFNGLSCISSORPROC, Scissor)                                                     \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                                           \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                                               \
    X(PFNGLTEXPARAMETERIPROC, TexParameteri)                                         \
    X(PFNGLTEXSUBIMAGE2DPROC, TexSubImage2D)                                         \
    X(PFNGLUNIFORM1FPROC, Uniform1f)                                                 \
    X(PFNGLUNIFORM1IPROC, Uniform1i)                                                 \
    X(PFNGLUNIFORM4FVPROC, Uniform4fv)                                               \
    X(PFNGLUNIFORMBLOCKBINDINGPROC, UniformBlockBinding)                             \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                                               \
    X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)                             \
    X(PFNGLVERTEXATTRIBIPOINTERPROC, VertexAttribIPointer)                           \
    X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)                             \
    X(PFNGLVIEWPORTPROC, Viewport)

namespace tumble {

struct GlFunctions {
#define TUMBLE_GL_MEMBER(type, name) type name = nullptr;
    TUMBLE_GL_FUNCTIONS(TUMBLE_GL_MEMBER)
#undef TUMBLE_GL_MEMBER
};

/// `find` returns the address of "glName" or null. Throws RunError that names a missing function.
GlFunctions load_gl_functions(const std::function<void*(const char*)>& find);

}  // namespace tumble
