#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/scalar_type.h"

namespace bspc::formats {

/// A column of a file: numbers of one type with a name, one a point.
struct Column {
  std::string name;
  ScalarType type = ScalarType::Float32;
};

/// An array and the columns that its components are.
struct GroupedColumns {
  ArrayDescription array;
  std::vector<std::size_t> columns;
};

/// Makes arrays of columns: nx, ny and nz become "Normals", red, green and blue (with or without
/// alpha) "RGB" or "RGBA", u and v "TextureCoordinates", and "name:0", "name:1" and so on "name",
/// where their types agree; every other column is an array of its own. Arrays are in the order of
/// their first columns, and columnsOf() gives the names back. The columns have different names.
std::vector<GroupedColumns> groupColumns(const std::vector<Column>& columns);

/// A column that an array becomes in a file: component `component` of array number `array`.
struct ArrayColumn : Column {
  std::size_t array = 0;
  std::size_t component = 0;
};

/// Makes columns of arrays, all of which have names of their own and none of them x, y or z.
/// Normals, colours and texture coordinates are named as groupColumns() wants them, by their
/// components where those have such names. Bits become UInt8. Throws FormatError if names clash.
std::vector<ArrayColumn> columnsOf(const std::vector<ArrayDescription>& arrays);

/// The names by which readers of files know what the components of normals, colours or texture
/// coordinates mean; empty if the array is none of these. In columnsOf(), other arrays of several
/// components are "name:0", "name:1" and so on.
std::vector<std::string> namesOfComponents(const ArrayDescription& array);

/// The name with blanks and control characters as "_", for formats that end words with them.
std::string wordOf(const std::string& name);

/// `name`, or that with the first number behind it which makes it none of `taken`.
std::string uniqueName(const std::string& name, const std::set<std::string>& taken);

}  // namespace bspc::formats
