// pipeline/mosaic/mapped_partials.h -- opens the files of a domain's partials near a time. Used
// only inside the pipeline room.
//
// Each partial holds a descriptor and a map. Only partials within 35 minutes of the requested times
// may contribute, so only these are opened. A radar has at most some twenty such partials. If a
// station has more than 24, only the last partial before each frame and the first partial after it
// stay open, so that a flood of volumes does not use up the descriptors.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// The longest time from the start of a volume, which names its grid, to the volume's middle.
inline constexpr std::chrono::milliseconds longest_to_middle = std::chrono::minutes{10};

// Returns the names of a domain's partials: "NAME.ICAO". Errors: the cache cannot be read.
[[nodiscard]] Result<std::vector<std::string>> partial_domains(const cache::StoreReader& store,
                                                               const std::string& domain);

// Says what happens if a partial cannot be read. A daemon leaves it out, so that it does not hold
// up the frames of other radars. A caller that makes each frame once gets an error.
enum class Unreadable { is_left_out, is_an_error };

struct OpenPartial {
    std::filesystem::path path;
    cache::GridFile file;
};

class MappedPartials {
  public:
    // Opens the partials that may contribute at an instant from `from` to `to`. Names in `problems`
    // the partials that cannot be opened. Leaves out partials that are no windows of the domain.
    // `store` and `domain` must outlive the object. Errors: the cache cannot be read; a shortage,
    // for example of descriptors; with Unreadable::is_an_error, io for a partial that cannot be
    // read.
    static Result<MappedPartials> open(const cache::StoreReader& store, const Domain& domain,
                                       level2::Moment moment, UtcTime from, UtcTime to,
                                       std::vector<std::string>& problems,
                                       Unreadable unreadable = Unreadable::is_left_out);

    // Returns the open partials. They are valid until drop_damaged() drops one.
    [[nodiscard]] std::vector<PartialView> views() const;
    // Returns ok if no file has been truncated while it was open.
    [[nodiscard]] Status check_whole() const;
    // Verifies all partials, drops the damaged ones, and names them in `problems`. Then opens
    // partials that may contribute in their place. Returns false if none was damaged. Errors: as in
    // open().
    Result<bool> drop_damaged(std::vector<std::string>& problems);

  private:
    Status load(std::vector<std::string>& problems);
    [[nodiscard]] bool ends_it(const Error& error) const;

    const cache::StoreReader* store_ = nullptr;
    const Domain* domain_ = nullptr;
    level2::Moment moment_ = level2::Moment::ref;
    UtcTime from_, to_;
    Unreadable unreadable_ = Unreadable::is_left_out;
    std::set<std::filesystem::path> bad_;  // partials that cannot be opened, or are damaged
    std::vector<OpenPartial> files_;
};

}  // namespace stormcellar::pipeline
