#include "fuzz_reader.h"

HEX_FUZZ_READER(read_open_volume_mesh)
