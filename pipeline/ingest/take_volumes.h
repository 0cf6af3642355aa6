// pipeline/ingest/take_volumes.h -- makes catalog rows, grids of the sites, and mosaics from the
// decoded volumes of one file.
//
// Inside the pipeline room only. Thread contract: one thread uses an object; the context must
// outlive it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/ingest/ingest_context.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {

// Tells take() whether it may grid a volume that has not ended. If not, the file waits for more
// data.
enum class MayBePartial : bool { no, yes };

class TakeVolumes {
  public:
    // `facts` describes the file, with the hash of its contents. take() completes `outcome`.
    TakeVolumes(IngestContext& context, catalog::FileFacts facts, IngestOutcome outcome)
        : context_(context), facts_(std::move(facts)), outcome_(std::move(outcome)) {}

    // Lets take() call `use` with the velocities of the volume and their VELD, if the file has one
    // volume and VELD was made.
    void set_use_dealiased(std::function<void(const level2::Volume&)> use) {
        use_dealiased_ = std::move(use);
    }
    // Takes the volumes. A file with more than 64 volumes is rejected. Errors: those of
    // Ingestor::ingest().
    Result<IngestOutcome> take(level2::Decoded decoded, MayBePartial partial);

  private:
    // The findings of the decoder about the file. They hold for all volumes of the file.
    struct Reading {
        bool is_complete = false;
        bool damaged = false;               // bytes were lost
        std::vector<std::string> troubles;  // of the radar, as its last message 2 says
    };

    void note(const level2::Decoded& decoded);
    void describe(const std::vector<level2::Volume>& volumes);
    [[nodiscard]] std::vector<std::string> troubles_of(const std::string& station) const;
    [[nodiscard]] bool is_partial(const level2::Volume& volume) const;
    [[nodiscard]] Result<bool> has_rival(const level2::Volume& volume) const;
    Result<IngestOutcome> reject(ErrorCode code, std::string why);
    Result<IngestOutcome> settle();
    Result<IngestOutcome> grid_all(std::vector<level2::Volume>& volumes);
    // Leaves out echo that is probably not weather, if the options say so, and returns the notes
    // for grids of the volume.
    std::vector<std::string> keep_wanted_echo(level2::Volume& volume);
    Status grid(const level2::Volume& volume, const std::vector<std::string>& notes);
    Status keep_mosaics(const level2::Volume& volume, const std::vector<std::string>& notes);

    IngestContext& context_;
    catalog::FileFacts facts_;
    IngestOutcome outcome_;
    Reading reading_;
    std::function<void(const level2::Volume&)> use_dealiased_;
};

}  // namespace stormcellar::pipeline
