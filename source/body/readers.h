/* What files of particles may be, as READER(name). A new one is a file and a line here: the file has `NAME_reader`, its table entry. */
READER(csv)
