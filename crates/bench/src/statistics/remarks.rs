//! Remarks on the figures: one sentence for each difference.

/// Below the table of costs, where times were taken on an idle machine.
pub const COST: &str = "\nMemory is that of the whole process. All figures except those per room grow with the number of rooms.\n";

/// Below the table of costs too, where the process did not get a processor for itself.
pub const SHARED: &str =
    "The machine had other work to do at the same time: on an idle one a home takes about as long as its processor time or less.\n";

/// Above the table of classes.
pub const CLASSES: &str = "
## Classes

Shares of the labelled instances, and of the homes that have the class. For Hypersim they refer to the 58,094 instances that its images
show, and to 482 scenes. A scene of Hypersim has 140 labelled instances on average (median 52.5), and is more often a room than a
home: each of our homes has most classes, because it has most kinds of rooms, while a bedroom of Hypersim has no toilet.
";

/// Above the table of small things.
pub const CLUTTER: &str = "
## Small things

A small thing is an instance whose box has a volume below 30 litres and no side of 0.6 m or more. Surface is what is level and faces up on
furniture, 0.3 to 2 m above the floor. Small things on the floor and on walls are counted too. The generator aims at 9 per m² of
furniture outside kitchens and dining rooms; no published counts were found.
Laid tables and glass cabinets make dining rooms the fullest. Kitchens look emptier than they are, since shelves below worktops count as
surface too.
";

/// Below the volumes of instances.
pub const VOLUMES: &str = "Our median is larger because books, plates and clothes in a row are one instance, and many in Hypersim.";

/// Why a class is more or less frequent than in Hypersim; empty where it is not.
pub fn of_class(class: i16) -> &'static str {
    match class {
        3 => "Every front of a fitted kitchen is its own instance; Hypersim's kitchens are often a single one.",
        4 | 17 | 32 => "Most homes have a bedroom; one of thirteen trajectories of Hypersim is in one.",
        5 => "Restaurants, offices and halls of Hypersim have dozens of chairs; ours are those of one table.",
        8 => "Every room has a door, and Hypersim's scenes are often one room with the door behind the camera.",
        9 => "Every habitable room has a window.",
        10 => "Most living rooms and studies have bookcases.",
        11 => "Every kind of habitable room has pictures.",
        12 => "Every home has a kitchen.",
        13 => "Only where there are no curtains; Hypersim labels many curtains as blinds.",
        14 => "Only studies have one; Hypersim has offices.",
        15 => "Wall shelves and towel shelves are separate instances.",
        16 => "Both sides and the rod are separate instances; Hypersim labels many curtains as blinds.",
        19 => "Bathrooms and halls have mirrors, and every home has both.",
        20 => "Bath mats and rugs, one in most rooms.",
        21 => "A pile or a coat is one instance; those of Hypersim are in 24 scenes, dozens in each.",
        23 => "A row of books is one instance; Hypersim's are mostly single.",
        24 => "Every home has a kitchen, and nearly every kitchen a refrigerator.",
        26 => "Magazines, notes and toilet paper are in every home.",
        30 => "In studies; Hypersim hardly has any.",
        31 => "There are no people in our homes.",
        33 => "Every home has a bathroom, a few of which have no room for the toilet; one of eighteen trajectories of Hypersim is in one.",
        27 | 28 | 34 | 36 => "Every home has a bathroom; one of eighteen trajectories of Hypersim is in one.",
        37 => "Hypersim has no labelled bags; halls and children's rooms have some.",
        38 => "Hobs, ovens, radiators, hoods and door casings are separate instances.",
        39 => "Benches, stands and machines for which NYU40 has no class.",
        _ => "",
    }
}
