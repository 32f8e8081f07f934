// Creates, extends and closes datasets through the HDF5 C API. Disk space is reserved before every flush, so that a
// full disk leaves a readable file.
#include "hdf5.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <unordered_set>

#include "traverse/base/error.hpp"
#include "traverse/base/version.hpp"

namespace traverse::results::hdf5 {

namespace {

constexpr off_t kEndOffset = 40;        // position of the file's end in superblock version 0, 8 bytes, little-endian
constexpr std::size_t kMaxOpen = 2000;  // datasets at the same time, of 20 kB each
constexpr std::size_t kMaxCompact = 1 << 12;  // bytes stored in the dataset's object header

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw FileError("cannot write the results file " + path + ": " + reason);
}

/// The system's message in an HDF5 one ("..., errno = 28, error message = 'No space left on device', ...").
std::string system_message(const std::string& text) {
  const std::string prefix = "error message = '";
  const auto begin = text.find(prefix);
  if (begin == std::string::npos) return {};
  const auto from = begin + prefix.size();
  return text.substr(from, text.find('\'', from) - from);
}

/// Visits HDF5's error stack from the innermost entry; stores the first system message, otherwise the first text.
herr_t visit(unsigned depth, const H5E_error2_t* entry, void* data) {
  auto& reason = *static_cast<std::string*>(data);
  const std::string text = entry->desc == nullptr ? "" : entry->desc;
  if (depth == 0) reason = text;
  if (const std::string message = system_message(text); !message.empty()) reason = message;
  return 0;
}

/// 0 if a link and its target are in this file. Other files are not allowed, because HDF5 would open, read and write
/// them.
herr_t is_in_this_file(hid_t group, const char* name, const H5L_info_t* link, void*) {
  if (link->type == H5L_TYPE_SOFT) return 0;
  if (link->type != H5L_TYPE_HARD) return 1;
  const Id object(H5Oopen(group, name, H5P_DEFAULT));
  if (H5Iget_type(object.get()) != H5I_DATASET) return object.get() < 0 ? -1 : 0;
  const Id creation(H5Dget_create_plist(object.get()));
  return H5Pget_external_count(creation.get()) == 0 && H5Pget_layout(creation.get()) != H5D_VIRTUAL ? 0 : 1;
}

}  // namespace

Id open_to_read(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Id access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access.get(), false, true);  // this program locks the file itself
  return Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
}

std::string text_of(const Id& file, const char* object, const char* attribute) {
  if (file.get() < 0 || H5Aexists_by_name(file.get(), object, attribute, H5P_DEFAULT) <= 0) return {};
  const Id value(H5Aopen_by_name(file.get(), object, attribute, H5P_DEFAULT, H5P_DEFAULT)),
      type(H5Aget_type(value.get()));
  if (type.get() < 0 || H5Tis_variable_str(type.get()) <= 0) return {};
  char* read = nullptr;
  if (H5Aread(value.get(), type.get(), static_cast<void*>(&read)) < 0 || read == nullptr) return {};
  std::string text = read;
  H5free_memory(read);
  return text;
}

Id open_whole(const std::string& path) {
  Id file = open_to_read(path);
  if (file.get() < 0) throw FileError(path + ": HDF5 cannot read it: the file is damaged");
  const herr_t external = H5Lvisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, is_in_this_file, nullptr);
  if (external < 0) throw FileError(path + ": HDF5 cannot read all of it: the file is damaged");
  if (external > 0) throw FileError(path + ": parts of it stand in other files, which are not looked for");
  const std::string written_by = text_of(file, "/", "program") == "traverse" ? text_of(file, "/", "version") : "";
  if (is_newer_major(written_by))
    throw FileError(path + ": was written by version " + written_by + " of Traverse, whose files version " + version() +
                    " cannot read");
  return file;
}

File::File(Place place) : place_(std::move(place)), path_(place_.path()) {
  place_.open_temporary();
  open(Id(check(H5Fcreate(place_.temporary_file().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access().get()))));
}

File::File(Place place, std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right)
    : place_(std::move(place)), path_(place_.path()) {
  place_.copy_temporarily(std::move(sources), is_right);
  open_existing(place_.temporary_file());
}

void File::open_existing(const std::string& path) {
  open(Id(check(H5Fopen(path.c_str(), H5F_ACC_RDWR, access().get()))));
  hsize_t size = 0;
  check(H5Fget_filesize(file_.get(), &size));
  reserved_ = static_cast<off_t>(size);
}

Id File::access() const {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Id access(check(H5Pcreate(H5P_FILE_ACCESS)));
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18));  // the oldest superblock
  check(H5Pset_file_locking(access.get(), false, true));                           // the place is locked
  // No allocation in advance: a flush returns the unused space, and shortens the file before it records that.
  check(H5Pset_meta_block_size(access.get(), 0));
  check(H5Pset_small_data_block_size(access.get(), 0));
  // The header of a series is rewritten with each of its blocks. A kill may divide a write between two pages of memory,
  // so that the checksum of a header on both would be wrong: none is, as headers are shorter than this and start at
  // multiples.
  constexpr hsize_t header = 512, shortest = 256;
  check(H5Pset_alignment(access.get(), shortest, header));
  check(H5Pset_sieve_buf_size(access.get(), 0));  // otherwise a failed write is detected only when a dataset is closed
  return access;
}

void File::open(Id file) {
  file_ = std::move(file);
  check(H5Fset_libver_bounds(file_.get(), H5F_LIBVER_V18, H5F_LIBVER_V18));  // with fast groups and datasets

  // No chunk cache: rows are written directly, none is rewritten, and no data wait in memory.
  rows_access_ = Id(check(H5Pcreate(H5P_DATASET_ACCESS)));
  check(H5Pset_chunk_cache(rows_access_.get(), 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT));
  compact_ = Id(check(H5Pcreate(H5P_DATASET_CREATE)));
  check(H5Pset_layout(compact_.get(), H5D_COMPACT));
  parents_ = Id(check(H5Pcreate(H5P_LINK_CREATE)));
  check(H5Pset_create_intermediate_group(parents_.get(), 1));
  text_ = Id(check(H5Tcopy(H5T_C_S1)));
  check(H5Tset_size(text_.get(), H5T_VARIABLE));
  check(H5Tset_cset(text_.get(), H5T_CSET_UTF8));
}

void File::publish() {
  flush();
  if (place_.has_temporary()) place_.replace_by_temporary();
}

void File::change_beside() {
  publish();
  for (Id* const id : {&parents_, &rows_access_, &compact_, &text_}) *id = Id();
  check(H5Fclose(file_.release()));
  const bool copied = place_.copy_temporarily();
  open_existing(copied ? place_.temporary_file() : place_.file());
}

std::vector<std::string> File::objects() const {
  std::vector<std::string> paths;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* to) {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return herr_t{0};
  };
  check(H5Lvisit(file_.get(), H5_INDEX_NAME, H5_ITER_INC, collect, &paths));
  return paths;
}

void File::remove_all_except(const std::vector<std::string>& paths) {
  const std::unordered_set<std::string> known(paths.begin(), paths.end());
  std::string removed = "/";  // the last removed group
  for (const std::string& path : objects()) {
    if (known.contains(path) || path.starts_with(removed)) continue;
    check(H5Ldelete(file_.get(), path.c_str(), H5P_DEFAULT));
    removed = path + "/";
  }
}

void File::remove_attribute(const std::string& object, const std::string& name) {
  if (check(H5Aexists_by_name(id(), object.c_str(), name.c_str(), H5P_DEFAULT)) > 0)
    check(H5Adelete_by_name(id(), object.c_str(), name.c_str(), H5P_DEFAULT));
}

hid_t File::check(hid_t result) const {
  if (result >= 0) return result;
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &reason);
  fail(path_, reason.empty() ? "HDF5 gives no reason" : reason);
}

int File::descriptor() const {
  void* handle = nullptr;
  check(H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &handle));
  return *static_cast<int*>(handle);
}

void File::secure_space() {
  haddr_t end = 0;
  check(H5Fget_eoa(file_.get(), &end));
  const auto size = static_cast<off_t>(end);
  if (size <= reserved_) return;
  const int error = posix_fallocate(descriptor(), reserved_, size - reserved_);
  if (error != 0) fail(path_, std::strerror(error));
  static_assert(std::endian::native == std::endian::little);
  if (pwrite(descriptor(), &end, sizeof(end), kEndOffset) != sizeof(end)) fail(path_, std::strerror(errno));
  reserved_ = size;
}

void File::flush() {
  attach_scales();
  secure_space();
  check(H5Fflush(file_.get(), H5F_SCOPE_LOCAL));
}

void File::close() {
  flush();
  check(H5Fclose(file_.get()));
  file_.release();
  if (place_.has_temporary())
    place_.replace_by_temporary();
  else
    place_.check_is_there();
  place_ = Place();
}

void File::abandon() noexcept {
  remove_made_place();  // also if the process ends without the destructors
  try {
    const int memory_file = memfd_create("traverse", MFD_CLOEXEC);
    if (memory_file < 0) return;
    dup2(memory_file, descriptor());
    ::close(memory_file);
  } catch (const FileError&) {  // no file was open
  }
  rlimit size{};
  getrlimit(RLIMIT_FSIZE, &size);
  // The limit applies to memory too, and HDF5 cannot close a file that it cannot write.
  if (size.rlim_cur != RLIM_INFINITY) file_.release();
}

Id File::group(const std::string& name) {
  return Id(check(H5Gcreate2(id(), name.c_str(), parents(), H5P_DEFAULT, H5P_DEFAULT)));
}

void File::write_attribute(const std::string& object, const std::string& name, hid_t type, const void* value) {
  remove_attribute(object, name);
  const Id space(check(H5Screate(H5S_SCALAR)));
  const Id attribute(check(
      H5Acreate_by_name(id(), object.c_str(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  check(H5Awrite(attribute.get(), type, value));
}

void File::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const std::string valid = printable(text);  // readers reject invalid UTF-8
  const char* value = valid.c_str();
  write_attribute(object, name, text_.get(), &value);
}

void File::attribute(const std::string& object, const std::string& name, double value) {
  write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void File::attribute(const std::string& object, const std::string& name, long value) {
  write_attribute(object, name, H5T_NATIVE_LONG, &value);
}

void File::dataset(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
                   const std::string& unit) {
  create(name, shape, values, unit, H5P_DEFAULT);
}

void File::fixed_dataset(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
                         const std::string& unit) {
  const bool small = values.size() * sizeof(double) <= kMaxCompact;
  create(name, shape, values, unit, small ? compact_.get() : H5P_DEFAULT);
}

void File::create(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
                  const std::string& unit, hid_t creation) {
  const Id space(check(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr)));
  const Id data(
      check(H5Dcreate2(id(), name.c_str(), H5T_NATIVE_DOUBLE, space.get(), parents(), creation, H5P_DEFAULT)));
  check(H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  label(data, name, unit);
}

void File::rewrite(const std::string& name, const std::vector<double>& values) {
  const Id data(check(H5Dopen2(id(), name.c_str(), H5P_DEFAULT)));
  check(H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void File::table(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows) {
  std::vector<std::pair<std::string, std::string>> valid;  // readers reject invalid UTF-8
  for (const auto& [key, value] : rows) valid.emplace_back(printable(key), printable(value));
  texts(name, valid);
}

void File::texts(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows) {
  std::vector<const char*> cells;
  for (const auto& [key, value] : rows) {
    cells.push_back(key.c_str());
    cells.push_back(value.c_str());
  }
  const hsize_t shape[] = {rows.size(), 2};
  const Id space(check(H5Screate_simple(2, shape, nullptr)));
  const Id data(check(H5Dcreate2(id(), name.c_str(), text_.get(), space.get(), parents(), H5P_DEFAULT, H5P_DEFAULT)));
  if (!rows.empty()) check(H5Dwrite(data.get(), text_.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, cells.data()));
  label(data, name, "text");
}

Id File::hold_open(Id dataset) {
  if (open_ == kMaxOpen) return {};
  ++open_;
  return dataset;
}

}  // namespace traverse::results::hdf5
