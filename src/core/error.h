// The two kinds of failure that a user can see; the third, a broken contract, is in check.h. A library layer throws one
// of these and never prints or exits: `app/` turns them into text and an exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace tumble {

/// A place in a text file, for error messages. Lines and columns count from 1; 0 means unknown.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// The input or the usage is wrong: exit code 2, and no output was written. what() is "FILE:LINE:COLUMN: error:
/// message"
/// with a known place, otherwise "error: message".
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message);
    InputError(const SourceLocation& where, const std::string& message);

    const SourceLocation& where() const { return where_; }
    const std::string& message() const { return message_; }  // without the place

private:
    SourceLocation where_;
    std::string message_;
};

/// The run failed: the environment (a full disk, no ffmpeg) or the numbers (a body with a NaN). Exit code 1; finished
/// frames stay. what() is "error: message".
class RunError : public std::runtime_error {
public:
    explicit RunError(const std::string& message);

    const std::string& message() const { return message_; }  // without "error: "

private:
    std::string message_;
};

/// The text of an error, what(), without "error: ".
std::string reason_of(std::string_view what);

/// A signal, such as that of Ctrl-C, ended the run.
class Interrupted : public RunError {
public:
    Interrupted() : RunError("interrupted") {}
};

}  // namespace tumble
