// level2/foreign/cfradial_values.h -- reads coordinates and texts of a CfRadial file.
//
// Threads   Constant after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arrayfile/array_file.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::level2 {

class CfradialValues {
  public:
    CfradialValues(std::span<const std::byte> bytes, std::uint64_t most_bytes)
        : bytes_(bytes), most_bytes_(most_bytes) {}

    // Return the numbers of an array, scaled; NaN for its fill value. If there is no such array of
    // numbers, or it cannot be read, the result is empty.
    [[nodiscard]] std::vector<double> numbers(const arrayfile::Array& array) const;
    [[nodiscard]] std::vector<double> numbers(const arrayfile::Group& group,
                                              std::string_view name) const;
    // Returns the texts of an array of letters, whose rows are texts; or none.
    [[nodiscard]] std::vector<std::string> texts(const arrayfile::Group& group,
                                                 std::string_view name) const;
    // Returns the times of rays. Errors: corrupt if the unit is not understood.
    [[nodiscard]] Result<std::vector<UtcTime>> times(const arrayfile::Group& group) const;

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t most_bytes_;
};

}  // namespace stormcellar::level2
