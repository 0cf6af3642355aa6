// cli/velocity/velocity_input.h -- reads the volumes for the commands that retrieve winds, and
// prints their JSON.
//
// Threads   One thread at a time.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "cli/shared/input_files.h"
#include "cli/shared/site_options.h"

namespace stormcellar::cli {

// Decodes a file, names and places its radar as requested, and splits it into volumes. Errors:
// those of InputFiles::decode() and apply_site().
[[nodiscard]] Result<std::vector<level2::Volume>> placed_volumes(InputFiles& inputs,
                                                                 const InputFile& file,
                                                                 const SiteRequest& site,
                                                                 int threads);

void print_document(const nlohmann::ordered_json& document);

}  // namespace stormcellar::cli
