# Builds decode_digest in the current folder: make -f decoder.mk ROOT=... SOURCES="src/... ..." CXX=... OPTIONS="..." [LIBRARIES=...]
# Only what changed is compiled again.
MAKEFLAGS += --no-builtin-rules
objects := $(addsuffix .o,$(subst /,_,$(sort $(patsubst %/,%,$(dir $(SOURCES))))))
# The system's headers come last, for Highway and xxHash: a cross compiler has a C library of its own.
flags := -std=c++20 -ffp-contract=off -fno-math-errno -fno-trapping-math -DXXH_INLINE_ALL -pthread -I$(ROOT)/include \
  -I$(ROOT)/src -I$(ROOT)/tests -isystem /usr/include/eigen3 -idirafter /usr/include $(OPTIONS)
compile := $(CXX) $(flags) -include common.h

decode_digest: $(objects)
	$(CXX) $(flags) -o $@ $^ $(LIBRARIES)

# A folder at once, which saves most of the time; where two of its files use a name for different things, one by one.
$(objects): %.o: common.h.gch
	@printf '#include "$(ROOT)/%s"\n' $(filter $(subst _,/,$*)/%,$(SOURCES)) >$*.cpp
	@$(compile) -MMD -MP -c -o $@ $*.cpp 2>$*.log || { \
	  for source in $(filter $(subst _,/,$*)/%,$(SOURCES)); do \
	    $(compile) -c -o $*-$$(basename $$source).o $(ROOT)/$$source || exit 1; \
	  done && $(CXX) $(OPTIONS) -r -nostdlib -o $@ $*-*.o; }

# Headers that hardly any file does without.
common.h.gch: $(MAKEFILE_LIST)
	@printf '#include <%s>\n' Eigen/Geometry algorithm array functional memory optional span string thread variant vector >common.h
	@$(CXX) $(flags) -x c++-header -o $@ common.h

# gcc's lists miss headers that Highway includes once for each instruction set.
$(objects): $(shell find $(ROOT)/include $(ROOT)/src $(ROOT)/tests/support -name '*.h')
-include $(objects:.o=.d)
