"""The constants of the C headers, as library/python/declare reads them. Do not edit."""

import enum


class Code(enum.IntEnum):
    """Stable names of all errors and warnings: 301 is W0301."""

    unexpected_character = 101  # a character that Wale does not use
    unterminated_text = 102  # a text or comment that does not end
    unexpected_token = 103  # something else was expected here
    missing_version = 104  # a file begins with its version of the language: wale 1
    newer_version = 105  # a newer version of the language than this compiler knows
    number_out_of_range = 106  # a number too large or too small to hold
    invalid_encoding = 107  # text that is not UTF-8, or holds a NUL byte
    nested_too_deep = 108  # nesting deeper than the compiler follows
    too_long = 109  # a file larger than the compiler reads
    unknown_name = 201  # a name that nothing declares
    declared_twice = 202  # a name declared twice
    unknown_unit = 203  # a unit that nothing declares
    unknown_argument = 204  # an argument that the function does not take
    missing_argument = 205  # an argument that the function needs
    unknown_setting = 206  # a setting that the declaration does not have
    missing_setting = 207  # a setting that the declaration needs
    ambiguous_name = 208  # a name that is both a unit and something else
    unused_name = 209  # a name that nothing uses
    recursive_definition = 211  # a definition that needs itself
    unknown_import = 212  # an import that cannot be found
    cyclic_import = 213  # imports that go round in a circle
    shadowed_name = 214  # a name that hides another of the same name
    private_name = 215  # a name that is private to its file
    unused_import = 216  # an import that is not used
    ambiguous_material = 217  # a name that may mean several materials
    wrong_dimension = 301  # a quantity of another dimension was expected
    mismatched_dimensions = 302  # the two sides have different dimensions
    wrong_type = 303  # a value of another type was expected
    not_constant = 304  # a value known at compile time was expected
    value_out_of_range = 305  # a value outside its range
    wrong_rate = 306  # a value that changes too often for its place
    unreachable = 307  # a part that can never be reached
    beyond_soft_range = 308  # a value outside its usual range
    under_resolution = 309  # a period too fine for the device
    raw_signal = 310  # a raw signal where a filtered one is meant
    unbounded_memory = 311  # a memory larger than a patch program may hold
    not_radians = 312  # an angle that does not seem to be in radians
    swapped_arguments = 313  # arguments that seem to be swapped
    unusable_shape = 314  # a shape that crosses itself, or that has no inside
    narrow_area = 315  # an area of a picture that is too narrow to be felt
    open_amplitude = 401  # a lateral force without an amplitude
    several_open = 402  # several quantities left open for one percept
    percept_conflict = 403  # a percept that contradicts the physics
    percept_unrealised = 404  # a percept that no force carries
    no_map = 405  # no map ties the percept to its carrier on this device
    level_out_of_range = 406  # a level outside 0 .. 1
    beyond_validity = 407  # a level outside the range that was measured
    saturates = 408  # more than the device can push
    flat_height = 409  # a texture without slope cannot push
    unsolvable_law = 410  # a law that cannot be solved for its carrier
    no_force = 411  # a material that says neither how it pushes nor how it feels
    different_structures = 412  # materials that cannot be mixed term by term
    recursive_material = 413  # a material made from itself
    scaled_texture = 414  # a texture solved for a percept and then scaled
    lost_percept = 415  # a percept that this device does not render
    map_dimension = 416  # a map whose law does not agree with its quantities
    inverse_out_of_range = 417  # a level that no size of the carrier has
    several_maps = 418  # several maps for one percept, and no choice
    untied_map = 419  # a percept without levels, or a map that is not tied to them
    unverified_basis = 420  # a level from a figure that nobody has checked
    reduced_percept = 421  # a percept reduced because the forces together are too much
    circular_couples = 422  # maps that couple each other in a circle
    close_levels = 423  # named levels that people can hardly tell apart
    cut_patch = 424  # a patch wider than the device's workspace
    delivered_otherwise = 425  # a level that the finished program does not have
    pushes_away = 426  # a force that drives a hand away from where it rests
    beyond_reach = 427  # a patch of a workspace that the device does not reach
    indistinct_neighbours = 428  # patches side by side that people cannot tell apart
    hidden_patch = 429  # a patch that lies wholly behind others
    jumping_height = 430  # a height that jumps, which no force can follow
    beyond_devices = 431  # a force far beyond what any device gives
    never_pushes = 432  # a material whose force is zero everywhere
    too_fast_for_loop = 433  # a rate that the device's loop cannot follow
    unmatched_colours = 434  # a part of a picture that has none of the colours
    too_small_for_hand = 435  # a patch or a gap of a workspace that is too small for a hand
    many_textures = 436  # more textures side by side than people recognise
    held_feature = 437  # a feature so small that its force is mostly held at the amplitude
    unreadable_file = 501  # a file that cannot be read
    unreadable_image = 502  # an image that cannot be read
    image_size = 503  # an image too small or too large
    unreadable_table = 504  # a measured table that cannot be read
    unwritable_file = 505  # a file that cannot be written
    damaged_file = 506  # a file whose bytes are not what its kind of file holds
    newer_file = 507  # a file of a newer format than this Wale reads
    output_is_input = 508  # an output that is one of the files read
    too_much_read = 509  # more imports, pictures or tables than one compilation reads
    unknown_device = 601  # a device that nothing declares
    unknown_material = 602  # a material that the file does not have
    program_too_large = 603  # more work than the compiler does, or more than a patch program holds
    undeclared_energy = 604  # energy that a material gives and does not declare
    more_than_device_gives = 605  # a program that declares more energy than the device gives
    refused_program = 606  # a patch program that the verifier does not let run
    other_device = 607  # a program built for another device
    other_figures = 608  # a program built for other figures of the device than its declaration has
    unknown_workspace = 609  # a workspace that the file does not have
    absent_device = 701  # a device that is not plugged in
    unusable_device = 702  # a device that is plugged in and cannot be used
    lost_device = 703  # a device that was lost while it was used
    unlike_device = 704  # a device that describes itself differently from its kind
    failed_transfer = 705  # a device that did not answer
    stopped = 706  # stopped by the person before anything was done
    no_permission = 707  # a device that this user may not open
    no_force_device = 708  # a device that is no force-feedback device
    no_keeper = 709  # the program that lets a device go cannot be started
    untrusted_device = 710  # a real device that only a file which is not trusted declares
    malformed_value = 801  # a value that cannot be read, or makes no sense here
    not_measured = 802  # a measurement that does not give the answer
    short_of_resources = 803  # the system gives no more memory, threads or descriptors
    wrong_moment = 804  # something that cannot be done now
    no_threshold = 805  # a percept whose just noticeable difference nobody has published
    missing_library = 806  # a library or program that this Wale needs for this and does not find
    no_sandbox = 807  # a system that offers no sandbox for foreign pictures
    incomplete_material = 901  # a material without all that a library needs
    no_licence = 902  # a material without a licence
    unfit_licence = 903  # a licence under which a shared library cannot pass a material on
    taken_name = 904  # a name that another material of the library has
    feels_the_same = 905  # a material that nobody tells from another one of its kind
    elsewhere_in_library = 906  # a file in another folder than that of its kind
    unformatted_file = 907  # a file that is not in the standard style
    still_there = 908  # a material that another one replaces, and that is still there
    shared_word = 909  # a name, in some language, that two materials share
    unfit_file = 910  # a link, or a file with a name that no library can hold
    not_for_class = 911  # a material that cannot be built for a class of devices
    reads_otherwise = 912  # a material that does not feel as it asks
    unstable_material = 913  # a material whose force needs more damping than device and hand have
    blank_material = 914  # a material that never pushes
    simulated_figures = 915  # a material that rests on what no person felt

    @property
    def title(self) -> str:
        """One line that describes the code in general."""
        return _titles[self]


_titles: dict[int, str] = {
    101: "a character that Wale does not use",
    102: "a text or comment that does not end",
    103: "something else was expected here",
    104: "a file begins with its version of the language: wale 1",
    105: "a newer version of the language than this compiler knows",
    106: "a number too large or too small to hold",
    107: "text that is not UTF-8, or holds a NUL byte",
    108: "nesting deeper than the compiler follows",
    109: "a file larger than the compiler reads",
    201: "a name that nothing declares",
    202: "a name declared twice",
    203: "a unit that nothing declares",
    204: "an argument that the function does not take",
    205: "an argument that the function needs",
    206: "a setting that the declaration does not have",
    207: "a setting that the declaration needs",
    208: "a name that is both a unit and something else",
    209: "a name that nothing uses",
    211: "a definition that needs itself",
    212: "an import that cannot be found",
    213: "imports that go round in a circle",
    214: "a name that hides another of the same name",
    215: "a name that is private to its file",
    216: "an import that is not used",
    217: "a name that may mean several materials",
    301: "a quantity of another dimension was expected",
    302: "the two sides have different dimensions",
    303: "a value of another type was expected",
    304: "a value known at compile time was expected",
    305: "a value outside its range",
    306: "a value that changes too often for its place",
    307: "a part that can never be reached",
    308: "a value outside its usual range",
    309: "a period too fine for the device",
    310: "a raw signal where a filtered one is meant",
    311: "a memory larger than a patch program may hold",
    312: "an angle that does not seem to be in radians",
    313: "arguments that seem to be swapped",
    314: "a shape that crosses itself, or that has no inside",
    315: "an area of a picture that is too narrow to be felt",
    401: "a lateral force without an amplitude",
    402: "several quantities left open for one percept",
    403: "a percept that contradicts the physics",
    404: "a percept that no force carries",
    405: "no map ties the percept to its carrier on this device",
    406: "a level outside 0 .. 1",
    407: "a level outside the range that was measured",
    408: "more than the device can push",
    409: "a texture without slope cannot push",
    410: "a law that cannot be solved for its carrier",
    411: "a material that says neither how it pushes nor how it feels",
    412: "materials that cannot be mixed term by term",
    413: "a material made from itself",
    414: "a texture solved for a percept and then scaled",
    415: "a percept that this device does not render",
    416: "a map whose law does not agree with its quantities",
    417: "a level that no size of the carrier has",
    418: "several maps for one percept, and no choice",
    419: "a percept without levels, or a map that is not tied to them",
    420: "a level from a figure that nobody has checked",
    421: "a percept reduced because the forces together are too much",
    422: "maps that couple each other in a circle",
    423: "named levels that people can hardly tell apart",
    424: "a patch wider than the device's workspace",
    425: "a level that the finished program does not have",
    426: "a force that drives a hand away from where it rests",
    427: "a patch of a workspace that the device does not reach",
    428: "patches side by side that people cannot tell apart",
    429: "a patch that lies wholly behind others",
    430: "a height that jumps, which no force can follow",
    431: "a force far beyond what any device gives",
    432: "a material whose force is zero everywhere",
    433: "a rate that the device's loop cannot follow",
    434: "a part of a picture that has none of the colours",
    435: "a patch or a gap of a workspace that is too small for a hand",
    436: "more textures side by side than people recognise",
    437: "a feature so small that its force is mostly held at the amplitude",
    501: "a file that cannot be read",
    502: "an image that cannot be read",
    503: "an image too small or too large",
    504: "a measured table that cannot be read",
    505: "a file that cannot be written",
    506: "a file whose bytes are not what its kind of file holds",
    507: "a file of a newer format than this Wale reads",
    508: "an output that is one of the files read",
    509: "more imports, pictures or tables than one compilation reads",
    601: "a device that nothing declares",
    602: "a material that the file does not have",
    603: "more work than the compiler does, or more than a patch program holds",
    604: "energy that a material gives and does not declare",
    605: "a program that declares more energy than the device gives",
    606: "a patch program that the verifier does not let run",
    607: "a program built for another device",
    608: "a program built for other figures of the device than its declaration has",
    609: "a workspace that the file does not have",
    701: "a device that is not plugged in",
    702: "a device that is plugged in and cannot be used",
    703: "a device that was lost while it was used",
    704: "a device that describes itself differently from its kind",
    705: "a device that did not answer",
    706: "stopped by the person before anything was done",
    707: "a device that this user may not open",
    708: "a device that is no force-feedback device",
    709: "the program that lets a device go cannot be started",
    710: "a real device that only a file which is not trusted declares",
    801: "a value that cannot be read, or makes no sense here",
    802: "a measurement that does not give the answer",
    803: "the system gives no more memory, threads or descriptors",
    804: "something that cannot be done now",
    805: "a percept whose just noticeable difference nobody has published",
    806: "a library or program that this Wale needs for this and does not find",
    807: "a system that offers no sandbox for foreign pictures",
    901: "a material without all that a library needs",
    902: "a material without a licence",
    903: "a licence under which a shared library cannot pass a material on",
    904: "a name that another material of the library has",
    905: "a material that nobody tells from another one of its kind",
    906: "a file in another folder than that of its kind",
    907: "a file that is not in the standard style",
    908: "a material that another one replaces, and that is still there",
    909: "a name, in some language, that two materials share",
    910: "a link, or a file with a name that no library can hold",
    911: "a material that cannot be built for a class of devices",
    912: "a material that does not feel as it asks",
    913: "a material whose force needs more damping than device and hand have",
    914: "a material that never pushes",
    915: "a material that rests on what no person felt",
}


class DeviceKind(enum.IntEnum):
    """Whether a device is plugged in, drawn, or simulated."""

    real = 0
    pointer = 1
    simulated = 2


class ContactKind(enum.IntEnum):
    """What begins or ends."""

    enter = 0
    leave = 1
    press = 2
    release = 3


class ReadingContact(enum.IntEnum):
    """Whether a device's position is valid now."""

    good = 0
    stale = 1
    lost = 2


class FateKind(enum.IntEnum):
    """How well a device renders what a text asks for."""

    kept = 1
    approximated = 2
    saturated = 3
    lost = 4


class MarkKind(enum.IntEnum):
    """Shapes that a picture shows."""

    point = 1
    circle = 2
    box = 3
    line = 4
    spring = 5
    trajectory = 6
