// The three descriptors that every program is started with, or should be.
#pragma once

namespace tumble {

/// Opens /dev/null in the place of standard input, output and error where they are closed (">&-"): the next file, pipe or
/// socket would get that number, and what is written to standard error would go there. Call it before anything is opened.
///
/// Standard output is opened for reading: what should go there and cannot is an error of the write, as it was.
void open_missing_standard_streams();

}  // namespace tumble
