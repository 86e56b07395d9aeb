// The causes of pixels apart from the scene: the program, its shaders, the libraries that draw, fonts, the processor.
#pragma once

#include "app/threads/interrupt.h"

#include <string>

namespace tumble {

/// A text that is the same as long as all of these are. Libraries are loaded in a process of their own. Precondition:
/// the program has no other thread.
std::string program_identity(Interrupt& interrupt);

}  // namespace tumble
