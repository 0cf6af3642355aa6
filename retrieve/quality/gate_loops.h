// retrieve/quality/gate_loops.h -- the innermost loops over the gates of a radial, for the vectors
// of each processor.
//
// Accuracy  Every target gives the same bits (tests/retrieve/gate_loops_test.cpp).
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::retrieve {

// Copies the codes from `first_valid` on, and writes 0 for lower codes.
void keep_valid_codes(const std::uint8_t* codes, std::size_t gates, std::uint16_t first_valid,
                      std::uint16_t* valid);
void keep_valid_codes(const std::uint16_t* codes, std::size_t gates, std::uint16_t first_valid,
                      std::uint16_t* valid);

// Numbers and sums have the form of BoxSum (gate_field.h): the lower `sum_bits` bits are a sum, and
// the bits above are a count.

// Writes the number of each code: a count of 1, and as the sum the code, but at most `most`. Code 0
// has no number.
void number_codes(const std::uint16_t* codes, std::size_t gates, std::uint32_t most,
                  std::uint32_t* numbers);

// Differences of codes around a circle of `turn` codes. A difference above `most` counts as `most`.
struct CodeDifferences {
    std::int32_t turn = 0;
    std::int32_t most = 0;
};
// Writes a count of 1 and, as the sum, the squared difference of two codes; writes 0 if one of the
// codes is 0.
void number_differences(const std::uint16_t* codes, const std::uint16_t* others, std::size_t gates,
                        const CodeDifferences& differences, std::uint32_t* numbers);

// Writes the sums of each `window` successive numbers, of which there are `gates` + window - 1.
// Overwrites the numbers.
void sum_windows(std::uint32_t* numbers, std::size_t gates, unsigned window, std::uint32_t* sums);

// Adds `row` to the sums, and takes `old` away.
void exchange_rows(const std::uint32_t* row, const std::uint32_t* old, std::size_t gates,
                   std::uint32_t* sums);

// Tells how a sum becomes a feature.
struct SumFeature {
    enum class Kind : std::uint8_t {
        mean,       // (mean - offset) / scale
        magnitude,  // the same without its sign
        root_mean,  // root of the mean / scale
        share,      // count / all
    };
    Kind kind = Kind::mean;
    float scale = 1, offset = 0, all = 1;
};
// Writes the feature of each sum. A sum of nothing has no mean (NaN), and a share of 0.
void features_of_sums(const std::uint32_t* sums, std::size_t count, const SumFeature& feature,
                      float* values);

// A table with equal steps between its first place and its last; one more place is for NaN.
struct StepTable {
    float first = 0, steps_per_unit = 0;
    std::int32_t last_step = 0;
    const float* entries = nullptr;
};
// Adds the entry of each value to a total.
void add_entries(const float* values, std::size_t count, const StepTable& table, float* totals);

}  // namespace stormcellar::retrieve
