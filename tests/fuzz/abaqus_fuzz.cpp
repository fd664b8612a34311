#include "fuzz_reader.h"

HEX_FUZZ_READER(read_abaqus)
