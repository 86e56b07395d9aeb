// The clock of times and traces.
#pragma once

namespace tumble {

/// Seconds of a monotonic clock, the same in all processes of the machine.
double wall_seconds();
/// Seconds of processor time of the calling thread.
double thread_seconds();

}  // namespace tumble
