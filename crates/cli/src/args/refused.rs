//! Options that a command shares in and refuses all the same.

use clap::Command;

/// Options of other commands that these refuse: the help leaves them out.
const REFUSED: [(&str, &[&str]); 3] = [
    ("path", &["mode", "settings", "pooling", "seed", "margin"]),
    (
        "scene",
        &[
            "mode",
            "settings",
            "pooling",
            "seed",
            "margin",
            "object_sensor",
            "sensor_pose",
            "collision_map",
            "robot",
            "robot_padding",
        ],
    ),
    (
        "robot",
        &[
            "mode",
            "settings",
            "pooling",
            "seed",
            "margin",
            "object_sensor",
            "robot",
            "robot_padding",
        ],
    ),
];

/// The same without these in the help; who gives one is told why not.
pub(super) fn hidden(command: Command) -> Command {
    REFUSED.iter().fold(command, |command, (name, options)| {
        command.mut_subcommand(name, |of| {
            options.iter().fold(of, |of, option| of.mut_arg(option, |arg| arg.hide(true)))
        })
    })
}
