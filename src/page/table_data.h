// The tables of a run as numbers of the clip data: energy, joints, impacts, contacts and loads.
#pragma once

#include "page/array_store.h"
#include "page/page_run.h"

namespace tumble {

ArrayStore::Json make_energy_data(const PageRun& run, ArrayStore& arrays);

/// By the names of the columns.
ArrayStore::Json make_joint_data(const PageRun& run, ArrayStore& arrays);

/// `precise`: with all digits, and with the bodies' events, which must be part of the data.
ArrayStore::Json make_impact_data(const PageRun& run, bool precise, ArrayStore& arrays);

/// Rows of the same two bodies are written as differences to their rows of the frame before.
ArrayStore::Json make_contact_data(const PageRun& run, ArrayStore& arrays);

/// Only of bodies with other loads than their weight.
ArrayStore::Json make_load_data(const PageRun& run, ArrayStore& arrays);

}  // namespace tumble
