#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "library/index/felt_columns.hpp"
#include "library/store/postgresql.hpp"
#include "library/store/read_library.hpp"

namespace wale {

/// A file as a shared index knows it, on whichever machine it lies: by the name of its library, its shelf, and its way from
/// there.
struct SharedFile {
  std::string shelf;  ///< "library"
  std::string way;    ///< "fabric/denim.wale"
  std::string root;   ///< the folder of the library here; no part of the index

  std::string path() const { return shelf + "/" + way; }
  /// 64 hexadecimal digits.
  std::string key() const;
};

/// The files as a shared index knows them. `shelf` is another name for the libraries on disk; empty: that of their folders.
/// Error: W0910 for a file in no library.
Result<std::vector<SharedFile>> shared_files(const std::vector<LibraryFile>& files, const std::string& shelf);

/// What a file rests on, by ways from its library's folder. Empty if it rests on a file outside, which nobody else has: such
/// a file is read anew each time. No path of this machine is in it.
std::string shared_rests_on(const SharedFile& file, const std::vector<std::pair<std::string, std::string>>& rests_on,
                            const std::string& named);

/// New contents of a file: all its materials.
struct SharedChange {
  SharedFile file;
  KnownFile known;
  std::vector<Entry> entries;
};

/// Puts changes into a shared index, all of them or none. Others who do the same wait meanwhile, and readers see what was
/// before until all is there. Errors: W0607 if the index is of another device, and those of the database.
Result<> put_into_shared(const SharedDatabase& database, const std::vector<SharedChange>& changes, const std::string& device);

/// W0607: the programs of an index are for one device.
Error of_other_device(const SharedDatabase& database, const std::string& device, const std::string& asked);

/// Takes files with these keys out, and counts their materials.
Result<std::size_t> take_out_of_shared(const SharedDatabase& database, const std::vector<std::string>& keys,
                                       const std::string& device);

/// An array of keys, as PostgreSQL reads one.
std::string array_of_keys(const std::vector<std::string>& keys);

/// A text that may mean a material, as the index has it: 64 hexadecimal digits.
std::string meant_key(std::string_view text);

/// What is felt of a material in bytes: of each quantity the length of its name in two bytes, the name, and its value in
/// four, the least byte first. As hexadecimal digits.
std::string felt_digits(const std::vector<std::pair<std::string, float>>& felt);
/// The same back. Ends where the digits make no sense.
std::vector<std::pair<std::string, float>> felt_of_digits(std::string_view digits);

}  // namespace wale
