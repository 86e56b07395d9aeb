// The three standard descriptors of a program.
#pragma once

namespace tumble {

/// Opens /dev/null for standard input, output and error if they are closed (">&-"). Otherwise the next file, pipe or
/// socket would get that number and receive, for example, the messages for standard error. Call it before anything is
/// opened.
///
/// Standard output is opened for reading, so that a write to it is still an error.
void open_missing_standard_streams();

}  // namespace tumble
