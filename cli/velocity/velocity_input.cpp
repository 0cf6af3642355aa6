#include "cli/velocity/velocity_input.h"

#include <utility>

#include <fmt/format.h>

namespace stormcellar::cli {

Result<std::vector<level2::Volume>> placed_volumes(InputFiles& inputs, const InputFile& file,
                                                   const SiteRequest& site, int threads) {
    level2::DecodeOptions options;
    options.threads = threads;
    auto decoded = inputs.decode(file, options);
    if (!decoded) return pass_on(decoded);
    if (Status applied = apply_site(site, decoded->volume); !applied) return pass_on(applied);
    return level2::split_volumes(std::move(*decoded));
}

void print_document(const nlohmann::ordered_json& document) {
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    fmt::print("{}\n", document.dump(1, ' ', true, replace));
}

}  // namespace stormcellar::cli
