// Locks that end with the process that holds them, however it ends.
#pragma once

#include <filesystem>

namespace tumble {

enum class Lock {
    taken,
    held,      // by another process, or by another opening of the file in this one
    unknown,   // the file system has no locks
};

/// Locks an open file for this opening of it alone, without waiting; the lock ends when the last copy of the descriptor
/// is closed. It is flock(), which Linux hands on to the server of a network file system.
Lock lock_file(int file);

/// Is it the open file that the path leads to? No longer, where another process has removed it meanwhile.
bool is_still_at(int file, const std::filesystem::path& path);

}  // namespace tumble
