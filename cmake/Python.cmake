# SPDX-License-Identifier: BSD-3-Clause
# The system's Python, as Python3::Interpreter and Python3::Python where its development files are. It is the one that ParaView
# embeds and that has h5py; a virtual environment or pyenv that comes first in PATH has neither. -DPython3_EXECUTABLE=... chooses
# another.
find_program(Python3_EXECUTABLE python3 PATHS /usr/bin /usr/local/bin NO_DEFAULT_PATH)
find_package(Python3 QUIET COMPONENTS Interpreter OPTIONAL_COMPONENTS Development.Embed Development.Module)
