// pipeline/ingest/finish_chunks.h -- finishes a volume in chunks when no more chunks are expected.
//
// Inside the pipeline room only. Thread contract: the caller must hold the volume's lock.
#pragma once

#include <string>

#include "pipeline/ingest/chunk_volumes.h"
#include "pipeline/ingest/ingest_context.h"

namespace stormcellar::pipeline {

// Returns the station in the volume's data, else the station in the chunk's path, else an empty
// text.
[[nodiscard]] std::string station_of(const ChunkVolume& volume, const ChunkPath& chunk);

// Decodes the volume from the chunks that it has, grids it, and settles the rows of all its files:
// the row of the first chunk describes the volume, and the other rows say that their chunks are
// part of it. `station` must be the result of station_of(), and `is_the_same` is the check of
// Ingestor::ingest_again(). Adds to the outcome. Errors: those of Ingestor::ingest(); the files
// must then be read again.
[[nodiscard]] Result<IngestOutcome> finish_chunks(IngestContext& context, ChunkVolume& volume,
                                                  const std::string& station,
                                                  const ReadCheck& is_the_same,
                                                  IngestOutcome outcome);

}  // namespace stormcellar::pipeline
