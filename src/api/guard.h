// Errors of the layers below as the exception of the interface.
#pragma once

#include "core/error.h"
#include "tumble/error.h"

#include <exception>
#include <new>
#include <utility>

namespace tumble::v0 {

/// Runs the work; InputError, RunError and other exceptions leave it as Error, std::bad_alloc as it is.
template <class Work>
decltype(auto) guarded(const Work& work) {
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
        throw Error(ErrorKind::run, {}, error.what());
    }
}

}  // namespace tumble::v0
