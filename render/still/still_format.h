// render/still/still_format.h -- the encoders behind stormcellar/render/still.h; internal.
//
// Each encoder returns the whole file in memory. Errors have a reason and no name of a file.
#pragma once

#include "stormcellar/render/still.h"

namespace stormcellar::render {

[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg(const Image& picture,
                                                         const StillOptions& options);
[[nodiscard]] Result<std::vector<std::byte>> encode_webp(const Image& picture,
                                                         const StillOptions& options);
[[nodiscard]] Result<std::vector<std::byte>> encode_geotiff(const StillMap& map,
                                                            const StillOptions& options);
[[nodiscard]] Result<std::vector<std::byte>> encode_netcdf(const StillMap& map,
                                                           const StillOptions& options);
[[nodiscard]] Result<std::vector<std::byte>> encode_grib(const StillMap& map,
                                                         const StillOptions& options);
[[nodiscard]] Result<std::vector<std::byte>> encode_kmz(const StillMap& map,
                                                        const StillOptions& options);

}  // namespace stormcellar::render
