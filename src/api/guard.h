// Errors of the layers below as the exception of the interface; checks of arguments.
#pragma once

#include "core/default_floating_point.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "tumble/error.h"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <new>
#include <utility>

namespace tumble::v0 {

/// Runs the work; InputError, RunError and other exceptions leave it as Error, std::bad_alloc as it is.
template <class Work>
decltype(auto) guarded(const Work& work) {
    const DefaultFloatingPoint default_floating_point;
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const InputError& error) {
        const SourceLocation& at = error.where();
        throw Error(ErrorKind::input, {at.file, at.line, at.column, {}}, error.message());
    } catch (const RunError& error) {
        throw Error(ErrorKind::run, {}, error.message());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(ErrorKind::run, {}, safe_lines(error.what()));
    }
}

/// The state behind an object. Throws InputError where a move took it away.
template <class State>
State& state_of(const std::unique_ptr<State>& state, const char* type) {
    if (state) return *state;
    throw InputError(fmt::format("this {} was moved from: use the object that it was moved to", type));
}

/// Part of the state of an object that writes a file.
struct Writing {
    const char* ended = nullptr;  // the reason why nothing can be added

    /// Throws InputError after finish() and after a failure.
    void check(const char* type) const {
        if (ended != nullptr)
            throw InputError(fmt::format("this {} {}: make another one for another file", type, ended));
    }
};

/// The state of an object that writes, ready for more. A failure of the work ends the file.
template <class State, class Work>
void write_with(const std::unique_ptr<State>& state, const char* type, const Work& work) {
    guarded([&] {
        State& open = state_of(state, type);
        open.check(type);
        try {
            work(open);
        } catch (const InputError&) {
            throw;  // before anything was written
        } catch (...) {
            open.ended = "failed";
            throw;
        }
    });
}

/// The same with the last work.
template <class State, class Work>
void finish_with(const std::unique_ptr<State>& state, const char* type, const Work& work) {
    write_with(state, type, [&](State& open) {
        work(open);
        open.ended = "is finished";
    });
}

inline void check_threads(int threads) {
    constexpr int most = 1024;  // beyond any machine; an absurd number is an argument that is wrong
    if (threads < 1 || threads > most)
        throw InputError(fmt::format("threads must be from 1 to {} (given {})", most, threads));
}

}  // namespace tumble::v0
