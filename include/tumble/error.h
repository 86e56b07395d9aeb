// The exception of the library. Every function of the interface may throw it, and std::bad_alloc.
#pragma once

#include "version.h"

#include <stdexcept>
#include <string>

TUMBLE_BEGIN

enum class ErrorKind {
    input,  // a scene, a file or an argument is wrong; nothing has been written
    run,    // the environment (a full disk, no ffmpeg, no OpenGL) or the numbers (a state that is not finite) failed
};

/// A place in the input. Lines and columns count from 1; 0 means unknown.
struct ErrorLocation {
    std::string file;  // empty where the error is not in a file
    int line = 0;
    int column = 0;
    std::string element;  // of a SceneSpec ("bodies[2].shape.radius"), LoadOptions or ClipTiming ("fps"), or empty
};

/// what() reads "FILE:LINE:COLUMN: error: MESSAGE", "ELEMENT: error: MESSAGE" or "error: MESSAGE".
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, ErrorLocation where, std::string message);
    Error(const Error&) = default;
    Error& operator=(const Error&) = default;
    ~Error() override;

    ErrorKind kind() const { return kind_; }
    const ErrorLocation& where() const { return where_; }
    const std::string& message() const { return message_; }  // without the place

private:
    ErrorKind kind_;
    ErrorLocation where_;
    std::string message_;
};

TUMBLE_END
