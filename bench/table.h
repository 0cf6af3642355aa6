// bench/table.h -- rows of measurements, printed as a table or as one JSON document.
//
// A row is a list of keys and values. As text, a row is printed as soon as it is added, with tabs
// between its values; a line of keys comes before the first row, and again when the keys change. As
// JSON, finish() prints {"machine": {...}, "rows": [{...}]}.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stormcellar::bench {

class Cell {
  public:
    Cell(std::string_view text) : text_(text), is_number_(false) {}
    Cell(const char* text) : Cell(std::string_view{text}) {}
    Cell(const std::string& text) : Cell(std::string_view{text}) {}
    Cell(int number) : text_(std::to_string(number)), is_number_(true) {}
    // Shows the number with this many decimals; as "-" or null if it is not finite.
    Cell(double number, int places);

    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] bool is_number() const { return is_number_; }

  private:
    std::string text_;
    bool is_number_;
};

using Row = std::vector<std::pair<std::string, Cell>>;

class Table {
  public:
    explicit Table(bool json) : json_(json) {}
    void add(Row row);
    void finish() const;

  private:
    bool json_;
    std::vector<Row> rows_;
};

}  // namespace stormcellar::bench
