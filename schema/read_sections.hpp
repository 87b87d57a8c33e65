#pragma once

#include <vector>

#include "schema/byte_reader.hpp"
#include "wale/patch_program.hpp"

namespace wale::patch_program_format {

// Each reads the content of one section of a patch program, up to its end, and throws the `Error` of a damaged file.

// read_machine_sections.cpp: what the machine needs to run the program
std::vector<float> read_constants(ByteReader& in);
std::vector<Parameter> read_parameters(ByteReader& in);
std::vector<Peak> read_peaks(ByteReader& in);
void read_states(ByteReader& in, PatchProgram& program);
void read_grids(ByteReader& in, PatchProgram& program);
void read_picture(ByteReader& in, Picture& picture);
void read_frame(ByteReader& in, Picture& picture);
std::vector<Output> read_outputs(ByteReader& in);
std::vector<HeightTable> read_tables(ByteReader& in);

// read_told_sections.cpp: what the program says of itself
std::vector<PerceptRecord> read_percepts(ByteReader& in);
/// Reads the basis of each percept; they have been read before.
std::vector<LevelClaim> read_claims(ByteReader& in);
void read_bases(ByteReader& in, std::vector<PerceptRecord>& percepts);
std::vector<FateRecord> read_fates(ByteReader& in);
Layers read_layers(ByteReader& in);
/// Reads the places of the program's code, which has been read before: this section stands after all others.
SourcePlaces read_places(ByteReader& in, const PatchProgram& program);

}  // namespace wale::patch_program_format
