// pipeline/ingest/finish_chunks.h -- a volume of chunks of which nothing more is waited for.
//
// Inside the pipeline room only. Thread contract: the caller holds the volume's lock.
#pragma once

#include <string>

#include "pipeline/ingest/chunk_volumes.h"
#include "pipeline/ingest/ingest_context.h"

namespace stormcellar::pipeline {

// The station that the volume's data name, or else the chunk's path.
[[nodiscard]] std::string station_of(const ChunkVolume& volume, const ChunkPath& chunk);

// Decodes the volume as it is, grids it, and settles the rows of all its files: that of the first
// chunk stands for the volume, those of the others say that they were taken in. `station`: as
// station_of() gives it; `is_the_same`: that of Ingestor::ingest_again(). Adds to the outcome.
// Errors: those of Ingestor::ingest(); then the files are to be read again.
[[nodiscard]] Result<IngestOutcome> finish_chunks(IngestContext& context, ChunkVolume& volume,
                                                  const std::string& station,
                                                  const ReadCheck& is_the_same,
                                                  IngestOutcome outcome);

}  // namespace stormcellar::pipeline
