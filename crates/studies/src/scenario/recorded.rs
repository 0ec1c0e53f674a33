//! The recorded log: columns, counts and axes.

use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, NodeId, Spot},
    quantity::Range,
    schema::{OneOrMore, Title},
    written,
};
use crate::{
    Diagnostic,
    log::{AxisMap, ColumnRef, Columns, Content, LogSpec, Scale, TimeColumn, message},
    units,
};

const COLUMNS: &str = "columns: { gyro: [gx, gy, gz], accel: [ax, ay, az] }";

pub(super) fn content(content: written::Content) -> Content {
    match content {
        written::Content::Increments => Content::Increments,
        written::Content::Rates => Content::Rates,
    }
}

pub(super) fn column(title: &Title) -> ColumnRef {
    match title {
        Title::Name(name) => ColumnRef::Name(name.clone()),
        Title::Number(number) => ColumnRef::Number(*number as usize),
    }
}

impl Document {
    /// A log of six axes, as navigation needs it.
    pub(super) fn imu_log(&self, w: &At<written::Log>) -> Result<LogSpec, Diagnostic> {
        let log = self.log(w)?;
        let columns = w.value.columns.as_ref().map(|columns| &columns.value);
        for (name, list, found) in [
            ("gyro", columns.and_then(|c| c.gyro.as_ref()), log.columns.gyro.len()),
            ("accel", columns.and_then(|c| c.accel.as_ref()), log.columns.accel.len()),
        ] {
            if found != 3 {
                let node = list.map_or(w.node, |list| list.node);
                return Err(self
                    .diagnostic(Spot::Node(node), "navigation needs three gyros and three accelerometers")
                    .found(format!("{found} columns under `{name}`"))
                    .example(COLUMNS));
            }
        }
        Ok(log)
    }

    /// A log with one axis or more.
    pub(super) fn log(&self, w: &At<written::Log>) -> Result<LogSpec, Diagnostic> {
        let (node, w) = (w.node, &w.value);
        if let Some(format) = &w.format {
            return self.log_of(format, w, node);
        }
        let missing = |key: &str| {
            self.diagnostic(Spot::Node(node), format!("the key `{key}` is missing"))
                .expected("it, or `format`")
        };
        let content = content(w.content.as_ref().ok_or_else(|| missing("content"))?.value);
        let columns = &w.columns.as_ref().ok_or_else(|| missing("columns"))?.value;
        let scale = &w.scale.as_ref().ok_or_else(|| missing("scale"))?.value;
        let per = match content {
            Content::Increments => Unit::SECOND,
            Content::Rates => Unit::ONE,
        };
        let time =
            scale.time.as_ref().map(|t| self.quantity(t, Unit::SECOND, Range::Positive)).transpose()?;
        let time_column =
            |title| TimeColumn { column: column(title), scale: time.unwrap_or(1.0), week: false };
        let (gyro, gyro_scale) = self.triad("gyro", &columns.gyro, &scale.gyro, Unit::RATE * per)?;
        let (accel, accel_scale) = self.triad("accel", &columns.accel, &scale.accel, Unit::FORCE * per)?;
        if gyro.is_empty() && accel.is_empty() {
            return Err(self
                .diagnostic(Spot::Node(node), "a log without gyros and without accelerometers")
                .expected("columns of one of them at least")
                .example(COLUMNS));
        }
        if let Some(axes) = &w.axes
            && [&gyro, &accel].iter().any(|triad| matches!(triad.len(), 1 | 2))
        {
            return Err(self
                .diagnostic(Spot::Node(axes.node), "axes cannot be turned where one is missing")
                .expected("three columns of each instrument that is there, or no `axes`"));
        }
        Ok(LogSpec {
            file: w.file.value.clone(),
            source: w.source.clone().unwrap_or_default(),
            rate: self.quantity(&w.rate, Unit::HERTZ, Range::Positive)?,
            content,
            columns: Columns { time: columns.time.as_ref().map(time_column), gyro, accel },
            scale: Scale { gyro: gyro_scale, accel: accel_scale },
            axes: w.axes.as_ref().map_or(Ok(AxisMap::IDENTITY), |axes| self.axes(axes))?,
            stationary: w.stationary.unwrap_or(false),
        })
    }

    /// A log of a format with a name.
    fn log_of(
        &self,
        format: &At<written::LogFormat>,
        w: &written::Log,
        node: NodeId,
    ) -> Result<LogSpec, Diagnostic> {
        let kf_gins = format.value == written::LogFormat::KfGins;
        let said = [
            ("content", w.content.as_ref().map(|x| x.node)),
            ("columns", w.columns.as_ref().map(|x| x.node)),
            ("scale", w.scale.as_ref().map(|x| x.node).filter(|_| kf_gins)),
        ];
        if let Some((key, Some(node))) = said.into_iter().find(|(_, node)| node.is_some()) {
            return Err(self
                .diagnostic(Spot::Node(node), format!("the format says what `{key}` is"))
                .help("take it out, or `format`"));
        }
        let (fields, scale, axes) = if kf_gins {
            ([1, 2, 3, 4, 5, 6, 7], Scale { gyro: [1.0; 3], accel: [1.0; 3] }, AxisMap::IDENTITY)
        } else {
            let scale = w
                .scale
                .as_ref()
                .and_then(|scale| Some((scale.value.gyro.as_ref()?, scale.value.accel.as_ref()?)));
            let Some((gyro, accel)) = scale else {
                return Err(self
                    .diagnostic(
                        Spot::Node(w.scale.as_ref().map_or(node, |scale| scale.node)),
                        "what one count is, is not known",
                    )
                    .path("log.scale")
                    .expected("the scale factors of the IMU, from the manual of the receiver")
                    .example(
                        "scale: { gyro: 1.1641532182693481e-10 rad, accel: 2.2709415078163147e-9 m/s }",
                    ));
            };
            // The message has the y axis with its sign turned.
            let turned = |[x, y, z]: [f64; 3]| [x, -y, z];
            let gyro = turned(self.each_axis(gyro, Unit::RADIAN, Range::Any)?);
            let accel = turned(self.each_axis(accel, Unit::METRE.over(Unit::SECOND), Range::Any)?);
            (message::FIELDS, Scale { gyro, accel }, AxisMap::RIGHT_FRONT_UP)
        };
        let [time, gyro @ .., _, _, _] = fields;
        let [.., a, b, c] = fields;
        let numbers = |fields: [usize; 3]| fields.map(ColumnRef::Number).to_vec();
        Ok(LogSpec {
            file: w.file.value.clone(),
            source: w.source.clone().unwrap_or_default(),
            rate: self.quantity(&w.rate, Unit::HERTZ, Range::Positive)?,
            content: Content::Increments,
            columns: Columns {
                time: Some(TimeColumn { column: ColumnRef::Number(time), scale: 1.0, week: true }),
                gyro: numbers(gyro),
                accel: numbers([a, b, c]),
            },
            scale,
            axes: w.axes.as_ref().map_or(Ok(axes), |axes| self.axes(axes))?,
            stationary: w.stationary.unwrap_or(false),
        })
    }

    /// Columns and counts of an instrument: both or neither.
    fn triad(
        &self,
        name: &str,
        columns: &Option<At<Vec<Title>>>,
        scale: &Option<At<OneOrMore>>,
        unit: Unit,
    ) -> Result<(Vec<ColumnRef>, [f64; 3]), Diagnostic> {
        match (columns, scale) {
            (Some(columns), Some(scale)) => {
                if !matches!(columns.value.len(), 1..=3) {
                    return Err(self
                        .diagnostic(
                            Spot::Node(columns.node),
                            format!("the list has {} entries", columns.value.len()),
                        )
                        .expected("the columns of x, y, z, or of the first of these axes")
                        .example(COLUMNS));
                }
                let scale = self.each_axis(scale, unit, Range::Any)?;
                Ok((columns.value.iter().map(column).collect(), scale))
            }
            (None, None) => Ok((Vec::new(), [1.0; 3])),
            (Some(there), None) => Err(self
                .diagnostic(Spot::Node(there.node), format!("the key `{name}` is missing"))
                .path("log.scale")
                .expected("what one count of these columns is")
                .example(units::example(unit))),
            (None, Some(there)) => Err(self
                .diagnostic(Spot::Node(there.node), format!("the key `{name}` is missing"))
                .path("log.columns")
                .expected("the columns that this count is of")
                .example(COLUMNS)),
        }
    }

    fn axes(&self, axes: &At<[At<String>; 3]>) -> Result<AxisMap, Diagnostic> {
        AxisMap::parse(axes.value.each_ref().map(|word| word.value.as_str())).map_err(|e| {
            self.diagnostic(Spot::Node(axes.node), e.to_string())
                .expected("the sensor axes that point forward, right and down")
                .example("[y, x, -z] for a sensor with x right, y forward, z up")
        })
    }
}
