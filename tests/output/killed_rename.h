// A process of the tests that is killed at a rename.
#pragma once

namespace tumble {

/// Calls of rename() that succeed until this process is killed at the next; -1: it is not. rename() is replaced in
/// part_file_test.cpp.
extern int renames_until_kill;

}  // namespace tumble
