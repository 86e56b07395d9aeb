// The tables of a run as numbers of the clip data: energy, impacts, contacts and loads.
#pragma once

#include "page/array_store.h"
#include "page/page_run.h"

namespace tumble {

ArrayStore::Json make_energy_data(const PageRun& run, ArrayStore& arrays);

/// `events`: whether the bodies' events are part of the data. Then the impacts are few, and their numbers exact.
ArrayStore::Json make_impact_data(const PageRun& run, bool events, ArrayStore& arrays);

/// Rows of the same two bodies are written as differences to those of the frame before.
ArrayStore::Json make_contact_data(const PageRun& run, ArrayStore& arrays);

/// Only of bodies with other loads than their weight.
ArrayStore::Json make_load_data(const PageRun& run, ArrayStore& arrays);

}  // namespace tumble
