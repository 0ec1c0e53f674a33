//! The track for maps.

use std::fmt::Write;

use crate::record::Table;

/// Points of a track that a map can still show.
const MOST_POINTS: usize = 10_000;

/// `track.kml` and `track.geojson`: longitude, latitude (deg), ellipsoidal height (m).
pub fn texts(title: &str, states: &Table) -> Vec<(String, String)> {
    let column = |name: &str| states.numbers(name).unwrap_or_default();
    let (lat, lon, h) = (column("lat_rad"), column("lon_rad"), column("h_m"));
    let stride = lat.len().div_ceil(MOST_POINTS).max(1);
    let mut rows: Vec<usize> = (0..lat.len()).step_by(stride).collect();
    if rows.last().is_some_and(|last| last + 1 < lat.len()) {
        rows.push(lat.len() - 1);
    }
    let point = |row: &usize| {
        let (lat, lon) = (lat[*row].to_degrees(), lon[*row].to_degrees());
        // 1e-8 deg is a millimetre.
        let lon = (lon + 540.0).rem_euclid(360.0) - 180.0;
        [format!("{lon:.8}"), format!("{lat:.8}"), format!("{:.3}", h[*row])].join(",")
    };
    let points: Vec<String> = rows.iter().map(point).collect();
    vec![("track.kml".into(), kml(title, &points)), ("track.geojson".into(), geojson(title, &points))]
}

fn kml(title: &str, points: &[String]) -> String {
    let escaped = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    text += "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Placemark>\n";
    let _ = writeln!(text, "<name>{escaped}</name>");
    text += "<LineString>\n<altitudeMode>absolute</altitudeMode>\n<coordinates>\n";
    text += &points.join("\n");
    text += "\n</coordinates>\n</LineString>\n</Placemark>\n</kml>\n";
    text
}

fn geojson(title: &str, points: &[String]) -> String {
    let name = serde_json::Value::from(title);
    let mut text = format!("{{\"type\":\"Feature\",\"properties\":{{\"name\":{name}}},\"geometry\":");
    let points: Vec<String> = points.iter().map(|point| format!("[{point}]")).collect();
    let _ = writeln!(text, "{{\"type\":\"LineString\",\"coordinates\":[\n{}\n]}}}}", points.join(",\n"));
    text
}
