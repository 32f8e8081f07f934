// Reads the datasets of the HDF5 group /separations as one entry for each loss of contact.
#include "support/separations.hpp"

#include <hdf5.h>

namespace traverse::test {
namespace {

/// The texts of a dataset, row by row; empty if there is no such dataset.
std::vector<std::string> texts(const std::string& file_name, const std::string& group, const std::string& name) {
  std::vector<std::string> out;
  const hid_t file = H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0) {
    const hid_t set = H5Dopen2(file, (group + "/" + name).c_str(), H5P_DEFAULT);
    const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
    std::vector<char*> cells(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), nullptr);
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, cells.data()) >= 0) {
      out.assign(cells.begin(), cells.end());
      H5Dvlen_reclaim(type, space, H5P_DEFAULT, cells.data());
    }
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(set);
  }
  H5Fclose(file);
  return out;
}

}  // namespace

std::vector<Separated> separations(Results& run) {
  const std::vector<std::string> names = texts(run.file(), "/separations", "contact");
  std::vector<Separated> list;
  for (std::size_t i = 0; 2 * i + 1 < names.size(); ++i)
    list.push_back({names[2 * i], names[2 * i + 1], run("/separations/x").at(i), run("/separations/start").at(i),
                    run("/separations/duration").at(i), run("/separations/approach_speed").at(i),
                    run("/separations/impact_force").at(i)});
  return list;
}

}  // namespace traverse::test
