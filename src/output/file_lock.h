// File locks that end with the process that holds them, even if it is killed.
#pragma once

#include <filesystem>

namespace tumble {

enum class Lock {
    taken,
    held,     // by another process, or by another open description of the file in this one
    unknown,  // the file system has no locks
};

enum class LockKind {
    alone,   // no other lock
    shared,  // with other shared ones
};

/// Locks an open file description, without waiting; the lock ends when the last copy of the descriptor is closed. It is
/// flock(), which Linux passes to the server of a network file system.
/// A second call changes the kind.
Lock lock_file(int file, LockKind kind = LockKind::alone);

/// True if the path still leads to the open file; false if another process has removed it.
bool is_still_at(int file, const std::filesystem::path& path);

}  // namespace tumble
