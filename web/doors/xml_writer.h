// web/doors/xml_writer.h -- writes escaped XML, one element on each line.
//
// Threads   One thread at a time.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stormcellar::web {

class XmlWriter {
  public:
    // Names and values are copied at once. Names of elements and attributes are not escaped,
    // because they come from the program itself.
    using Attributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

    XmlWriter();  // writes the declaration of XML 1.0 in UTF-8
    XmlWriter& open(std::string_view name, Attributes attributes = {});
    XmlWriter& close();  // closes the element that was opened last
    XmlWriter& leaf(std::string_view name, std::string_view text, Attributes attributes = {});
    XmlWriter& empty(std::string_view name, Attributes attributes = {});
    // Closes all open elements and returns the document.
    [[nodiscard]] std::string take();

  private:
    void begin(std::string_view name, Attributes attributes);
    std::string text_;
    std::vector<std::string> open_;
};

}  // namespace stormcellar::web
