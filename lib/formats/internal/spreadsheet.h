// The sheets of a workbook in Office Open XML (XLSX, ECMA-376 part 1), which is a ZIP archive of XML parts, as text.
// Only the parts that hold cells are unpacked, into memory, and no further than a workbook in use would go.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/result.h"

namespace goniochrome::formats {

// A cell that is not empty.
struct SheetCell {
  int column = 0;  // from 0
  // Numbers as they are stored, those that are shown as percent as `45%`, dates as in 2024-08-20 15:44:19.
  std::string text;
};

struct SheetRow {
  int number = 0;                // from 1
  std::vector<SheetCell> cells;  // by ascending column

  // The text in a column; "" where the cell is empty.
  std::string_view at(int column) const;
};

struct Sheet {
  std::string name;
  std::vector<SheetRow> rows;  // that are not empty, in order; the cells of a merged range all have its text
  int formulas_without_value = 0;
  bool is_hidden = false;
  int hidden_rows = 0;
};

class Spreadsheet {
 public:
  // Error: the input is no workbook, is encrypted, is cut off, or is larger than 1 GiB.
  static Result<Spreadsheet> open(InputFile input);
  Spreadsheet(Spreadsheet&&) noexcept;
  ~Spreadsheet();

  std::size_t sheet_count() const;

  // The sheet with the index, in the order of its tabs. Error: a part is missing, is no XML, unpacks to far more than
  // it is packed, or has more than four million cells; with the sheet's name.
  Result<Sheet> sheet(std::size_t index);

 private:
  struct State;
  explicit Spreadsheet(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// The column (from 0) and the row (from 1) that a reference such as AB12 means. Error: it is none.
struct CellPlace {
  int column = 0, row = 0;
};
Result<CellPlace> cell_place(std::string_view reference);

// The date and time that a workbook stores as days since the end of 1899, or of 1903 where it says that it counts so.
std::string date_text(double days, bool since_1904 = false);

}  // namespace goniochrome::formats
