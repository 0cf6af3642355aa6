// export/uf_record.h -- one record of a UF file while it is made; internal to export.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "export/uf_scale.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::netcdf {

// Places of words are counted from 1, as the format counts them.
class UfRecord {
  public:
    // The place of the next word.
    [[nodiscard]] std::size_t next() const { return words_.size() + 1; }
    void clear() { words_.clear(); }

    // Adds a number, rounded; uf_missing if it is not finite or too large.
    void add(double number);
    void add(std::optional<double> number);
    void add_missing(std::size_t count) { words_.insert(words_.end(), count, uf_missing); }
    // Adds letters, two in a word: the text, cut or filled with blanks.
    void add_text(std::string text, std::size_t letters);
    // Adds degrees, minutes and seconds * 64. All have the sign of the angle.
    void add_angle(std::optional<double> degrees);
    void add_date(UtcTime time);  // year, month, day
    void add_time(UtcTime time);  // date, hour, minute, second
    void set(std::size_t place, std::size_t number) {
        words_[place - 1] = static_cast<std::int16_t>(number);
    }
    // Adds `count` words that are missing, and returns them.
    [[nodiscard]] std::span<std::int16_t> add_gates(std::size_t count) {
        add_missing(count);
        return std::span(words_).last(count);
    }

    // Appends the record with its length in bytes before and after it, big-endian.
    void append_to(std::vector<std::byte>& file) const;

  private:
    std::vector<std::int16_t> words_;
};

}  // namespace stormcellar::netcdf
