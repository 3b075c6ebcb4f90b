# Builds decode_digest in the current folder: make -f decoder.mk ROOT=... SOURCES="src/... ..." CXX=... OPTIONS="..." [LIBRARIES=...]
# Only what changed is compiled again.
objects := $(SOURCES:.cpp=.o)
# The system's headers come last, for Highway and xxHash: a cross compiler has a C library of its own.
flags := -std=c++20 -ffp-contract=off -fno-math-errno -fno-trapping-math -DXXH_INLINE_ALL -pthread -I$(ROOT)/include \
  -I$(ROOT)/src -I$(ROOT)/tests -isystem /usr/include/eigen3 -idirafter /usr/include $(OPTIONS)

decode_digest: $(objects)
	$(CXX) $(flags) -o $@ $^ $(LIBRARIES)

%.o: $(ROOT)/%.cpp common.h.gch
	@mkdir -p $(@D)
	$(CXX) $(flags) -MMD -MP -include common.h -c -o $@ $<

# Most of the time goes into headers that hardly any file does without.
common.h.gch: $(MAKEFILE_LIST)
	printf '#include <%s>\n' Eigen/Geometry algorithm array functional memory optional span string thread variant vector >common.h
	$(CXX) $(flags) -x c++-header -o $@ common.h

-include $(objects:.o=.d)
