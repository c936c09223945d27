//! Options that a command shares in and refuses all the same.

use clap::Command;

/// What no command of the calibrated mode alone takes; `--margin` is of one pose, too.
const EVERYWHERE: [&str; 5] = ["mode", "settings", "pooling", "seed", "margin"];

/// These commands, and what each of them refuses besides: the help leaves all of it out.
const REFUSED: [(&str, &[&str]); 3] = [
    ("path", &[]),
    ("scene", &["object_sensor", "sensor_pose", "collision_map", "robot", "robot_padding"]),
    ("robot", &["object_sensor", "robot", "robot_padding"]),
];

/// The same without these in the help; who gives one is told why not.
pub(super) fn hidden(command: Command) -> Command {
    REFUSED.into_iter().fold(command, |command, (name, options)| {
        command.mut_subcommand(name, |of| {
            EVERYWHERE
                .iter()
                .chain(options)
                .fold(of, |of, option| of.mut_arg(option, |arg| arg.hide(true)))
        })
    })
}
